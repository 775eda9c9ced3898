#!/usr/bin/env python3
"""Whether recordings came back sample by sample:

    same_samples.py WROTE READ [--epoch S] --steps SECONDS DEGREES HEADING PULSE

WROTE and READ: folders of a telemetry log; READ counts its times from --epoch. The steps are the digits that the
recording in between can hold, of time (s), position (deg), heading (deg) and pulse width (us): each value comes back
to half of one. Exits with 1 and says where, if not.
"""
import argparse
import csv
import pathlib
import sys

HALF_DIGIT = 0.5 + 1e-6

arguments = argparse.ArgumentParser()
arguments.add_argument("wrote", type=pathlib.Path)
arguments.add_argument("read", type=pathlib.Path)
arguments.add_argument("--epoch", type=float, default=0.0)
arguments.add_argument("--steps", type=float, nargs=4, required=True)
given = arguments.parse_args()


def read(folder, channel):
    with open(folder / f"{channel}.csv", newline="") as file:
        return [[float(cell) for cell in row] for row in list(csv.reader(file))[1:]]


def turn(degrees):
    return (degrees + 180.0) % 360.0 - 180.0


def fault(channel, step):
    wanted, got = read(given.wrote, channel), read(given.read, channel)
    if len(wanted) != len(got):
        return f"{len(got)} samples of {len(wanted)}"
    for row, (w, g) in enumerate(zip(wanted, got)):
        apart = [turn(a - b) if channel == "heading" else a - b for a, b in zip(w[1:], g[1:])]
        if abs(g[0] - given.epoch - w[0]) > HALF_DIGIT * given.steps[0] or any(
                abs(value) > HALF_DIGIT * step for value in apart):
            return f"row {row}: wrote {w}, read {g}"
    return None


faults = {channel: found for channel, step in zip(("gnss", "heading", "thrusters"), given.steps[1:])
          if (found := fault(channel, step))}
for channel, found in faults.items():
    print(f"FAILED: {given.read.name}: {channel}: {found}", file=sys.stderr)
sys.exit(1 if faults else 0)
