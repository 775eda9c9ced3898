#!/usr/bin/env python3
"""Do the estimates that identification makes of one recording alone show what was done to it? Alters real recordings as
bench/altered_real_runs.py does, identifies each by itself, and prints in Markdown by how much its delays, its excess of
starboard thrust and its heading against the course over ground differ from those of the boat's other runs, unaltered.
Each stands with z, the difference over its standard deviation of one more day:

    v = se^2 + b + max(b, mean of the references' se^2) / m,  b = (sum of squares about the references' mean + p^2) / m

with m references and p = 0.02 s, 0.02, and 1 degree, as one more reference that differs by so much.

Usage: bench/own_estimates_of_real_runs.py [--built DIR] [--data DIR] [--threads N]

Runs telltale and blind_alter of build/release unless --built names another build folder, on the BlueBoat runs of
../shared/data unless --data names another folder; without them it exits 77. Needs numpy.
"""
import argparse
import csv
import itertools
import json
import math
import pathlib
import sys
import tempfile

import numpy as np

import altered_real_runs as real

EARTH_M = 6371000.0
STEP_S = 1.0  # over which fixes become velocities
BLOCK_S = 10.0  # within which errors may be correlated
ESTIMATES = {"commands, s": 0.02, "fixes, s": 0.02, "starboard thrust": 0.02, "heading, degrees": 1.0}


def columns(file):
    with open(file, newline="") as rows:
        return np.array([[float(v) for v in row] for row in list(csv.reader(rows))[1:]]).T


def velocities(log):
    """Times, velocities north and east (m/s) from fixes, heading (rad) and its rate (rad/s) at their middle."""
    time_s, latitude, longitude = columns(log / "gnss.csv")
    north = np.radians(latitude - latitude[0]) * EARTH_M
    east = np.radians(longitude - longitude[0]) * EARTH_M * math.cos(math.radians(latitude[0]))
    heading_s, heading = columns(log / "heading.csv")
    psi = np.unwrap(np.radians(heading))
    middle_s = np.arange(time_s[0] + STEP_S, time_s[-1] - STEP_S, STEP_S)

    def rate(values, times):
        before, after = (np.interp(middle_s + shift, times, values) for shift in (-0.5 * STEP_S, 0.5 * STEP_S))
        return (after - before) / STEP_S

    return middle_s, rate(north, time_s), rate(east, time_s), np.interp(middle_s, heading_s, psi), rate(psi, heading_s)


def heading_bias(log):
    """By how many degrees the heading is turned against the course, beside a steady current and the sideslip of turns:
    v = -bias u + c_N (-sin psi) + c_E cos psi + a r + b u r by least squares, as (125) of docs/concepts/diagnosis.md has
    it, with a standard error by leaving out blocks (jackknife)."""
    time_s, north, east, psi, r = velocities(log)
    u = north * np.cos(psi) + east * np.sin(psi)
    v = -north * np.sin(psi) + east * np.cos(psi)
    regressors = np.column_stack([-u, -np.sin(psi), np.cos(psi), r, u * r])
    blocks = ((time_s - time_s[0]) // BLOCK_S).astype(int)

    def fit(kept):
        return np.linalg.lstsq(regressors[kept], v[kept], rcond=None)[0][0]

    without = np.array([fit(blocks != block) for block in np.unique(blocks)])
    spread = (without.size - 1) / without.size * np.sum((without - without.mean()) ** 2)
    return math.degrees(fit(blocks >= 0)), math.degrees(math.sqrt(spread))


def estimates(boat, log):
    """By name: estimate and standard error of one recording alone."""
    out = boat.folder / "alone.json"
    real.run(boat.telltale, "identify", "--log", log, "--vehicle", boat.vehicle, "--structure", "fossen", "--threads",
             boat.threads, "--out", out)
    model = json.loads(out.read_text())
    parameters = {p["symbol"]: p for p in model["parameters"]}
    found = [model["delays"]["commands"], model["delays"]["fixes"], parameters["Tps"]]
    values = [(p.get("estimate", 0.0), p["standardError"]) for p in found] + [heading_bias(log)]
    return dict(zip(ESTIMATES, values))


def difference(name, own, references):
    """Of one estimate: the difference from the references' mean, and z."""
    count = len(references)
    estimate, error = own[name]
    mean = sum(r[name][0] for r in references) / count
    within = sum(r[name][1] ** 2 for r in references) / count
    between = (sum((r[name][0] - mean) ** 2 for r in references) + ESTIMATES[name] ** 2) / count
    return estimate - mean, (estimate - mean) / math.sqrt(error**2 + between + max(between, within) / count)


def print_alterations(runs, found):
    print(f"| run | alteration | {' | '.join(ESTIMATES)} |")
    print("|---|---|" + "---|" * len(ESTIMATES))
    for held in runs:
        references = [found[other, "none"] for other in runs if other != held]
        for alteration in real.ALTERATIONS:
            pairs = [difference(name, found[held, alteration.name], references) for name in ESTIMATES]
            cells = " | ".join(f"{by:+.2f} ({z:+.1f})" for by, z in pairs)
            print(f"| {held} | {alteration.name} | {cells} |")


def print_choices(runs, found):
    print("\nLargest z of each unaltered run over every choice of three references:\n")
    print(f"| run | {' | '.join(ESTIMATES)} |")
    print("|---|" + "---|" * len(ESTIMATES))
    for held in runs:
        choices = list(itertools.combinations([found[other, "none"] for other in runs if other != held], 3))
        largest = [max((difference(name, found[held, "none"], c)[1] for c in choices), key=abs) for name in ESTIMATES]
        print(f"| {held} | {' | '.join(f'{z:+.1f}' for z in largest)} |")


def main():
    root = pathlib.Path(__file__).resolve().parent.parent
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--built", type=pathlib.Path, default=root / "build/release")
    parser.add_argument("--data", type=pathlib.Path, default=root / "../shared/data")
    parser.add_argument("--threads", type=int, default=1)
    arguments = parser.parse_args()
    if not (arguments.data / "blueboat").is_dir():
        print(f"own_estimates_of_real_runs: skipped, no recordings at {arguments.data / 'blueboat'}", file=sys.stderr)
        sys.exit(real.SKIPPED)
    found = {}
    with tempfile.TemporaryDirectory() as folder:
        boat = real.Boat(arguments, root, pathlib.Path(folder))
        for held in boat.runs:
            model = boat.model([run for run in boat.runs if run != held])
            for alteration in real.ALTERATIONS:
                log, _ = boat.altered(held, alteration, model)
                found[held, alteration.name] = estimates(boat, log)
        print_alterations(boat.runs, found)
        print_choices(boat.runs, found)


if __name__ == "__main__":
    main()
