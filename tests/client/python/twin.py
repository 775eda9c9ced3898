"""Recordings of the simulated boat, and the commands to hold the package against.

The environment names the programs: TELLTALE_COMMAND and TELLTALE_TWIN.
"""

import json
import os
import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[3]
SAMPLE = ROOT / "deploy/sample"
BOAT = SAMPLE / "yellowfish.textproto"


def record(folder, **options):
    """A recording of the sample mission: record(folder, duration=120, seed=2, port_strength=0.6)."""
    named = [f"--{name.replace('_', '-')}={value}" for name, value in options.items()]
    subprocess.run([os.environ["TELLTALE_TWIN"], "--out", folder, *named], check=True)
    return folder


def set_adrift(folder, north):
    """Lets a current run north through a recording: water moves all fixes, and nothing else."""
    metre_deg = 1 / 111_000
    file = folder / "gnss.csv"
    header, *rows = file.read_text().splitlines()
    drifted = [header]
    for row in rows:
        time_s, latitude_deg, longitude_deg = map(float, row.split(","))
        drifted.append(f"{time_s},{latitude_deg + north * time_s * metre_deg:.10f},{longitude_deg}")
    file.write_text("\n".join(drifted) + "\n")


def telltale(*arguments):
    """What the command does: its exit code, and what it prints on standard output and error."""
    return subprocess.run([os.environ["TELLTALE_COMMAND"], *map(str, arguments)], capture_output=True, text=True, check=False)


def answer(*arguments):
    """The JSON with which the command answers."""
    run = telltale(*arguments, "--json")
    if run.returncode != 0:
        raise AssertionError(f"telltale exited {run.returncode}: {run.stderr}")
    return json.loads(run.stdout)


def words(text):
    """A text without its line breaks, and with options spelled as arguments of functions are."""
    spelled = [word.replace("-", "_") if word.startswith("--") else word for word in text.split()]
    return " ".join(spelled).replace("__", "")
