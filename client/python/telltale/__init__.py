"""Identifies how autonomous surface vehicles respond to their thrusters, with bounds.

    recording = telltale.load("my-recording", vehicle="boat.textproto")
    for finding in telltale.check(recording).findings:
        print(finding)
    model = telltale.identify(recording)
    model.save("model.json")

Times are in seconds of the recording's clock, positions in metres north and east, velocities in m/s and rad/s in the
axes of the boat, commands in shares of full command, port first. All else says its unit in its name.
"""

from telltale._telltale import (
    CausalEffect,
    Cause,
    Change,
    Check,
    Coefficient,
    CoefficientChange,
    Delays,
    Diagnosis,
    Direction,
    Draws,
    Finding,
    FreeRunScore,
    FreeRunScores,
    Gains,
    Model,
    OneStepScore,
    ParameterEstimate,
    PwmChannel,
    Recording,
    Scores,
    Track,
    Vehicle,
    __version__,
    check,
    compare,
    diagnose,
    export,
    gain,
    identify,
    load,
    load_model,
    load_vehicle,
    simulate,
    validate,
)
from telltale.errors import DataCannotTell, InputError

__all__ = [
    "CausalEffect",
    "Cause",
    "Change",
    "Check",
    "Coefficient",
    "CoefficientChange",
    "DataCannotTell",
    "Delays",
    "Diagnosis",
    "Direction",
    "Draws",
    "Finding",
    "FreeRunScore",
    "FreeRunScores",
    "Gains",
    "InputError",
    "Model",
    "OneStepScore",
    "ParameterEstimate",
    "PwmChannel",
    "Recording",
    "Scores",
    "Track",
    "Vehicle",
    "__version__",
    "check",
    "compare",
    "diagnose",
    "export",
    "gain",
    "identify",
    "load",
    "load_model",
    "load_vehicle",
    "simulate",
    "validate",
]
