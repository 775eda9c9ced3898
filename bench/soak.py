#!/usr/bin/env python3
"""Whether a daemon grows over days: docs/validation/reliability.md.

  soak.py [--boats N] [--speed X] [--minutes M]

`telltale load` sends the telemetry of boats whose clocks run X times as fast, and one boat is identified again and again.
Prints the daemon's memory, descriptors and store as time goes on, and how far each grew in the second half.
TELLTALE_BUILT names the build folder.
"""
import argparse
import time

from daemon_under_load import Fleet

LINES = 20


def identify_until(end, fleet):
    done = 0
    while time.monotonic() < end:
        done += fleet.telltale("identify", "--vehicle-id", "load-00001").returncode == 0
    return done


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--boats", type=int, default=10)
    arguments.add_argument("--speed", type=int, default=50)
    arguments.add_argument("--minutes", type=float, default=10)
    given = arguments.parse_args()
    seconds = 60 * given.minutes
    with Fleet(given.boats, load_options=("--speed", str(given.speed))) as fleet:
        fleet.await_telemetry()
        begun, identified, seen = time.monotonic(), 0, []
        print("hours of data | resident MB | descriptors | store MB | identifications")
        for line in range(1, LINES + 1):
            identified += identify_until(begun + seconds * line / LINES, fleet)
            seen.append((fleet.resident_bytes() / 1e6, fleet.open_descriptors(), fleet.stored_bytes() / 1e6))
            hours = (time.monotonic() - begun) * given.speed / 3600
            print(f"{hours:.1f} | {seen[-1][0]:.0f} | {seen[-1][1]} | {seen[-1][2]:.1f} | {identified}", flush=True)
        received, lost = (fleet.total(f"telltale_{name}_total") for name in ("received_samples", "vehicle_samples_lost"))
    for name, values in zip(("resident memory", "descriptors", "store"), zip(*seen)):
        half = values[LINES // 2 - 1:]
        print(f"{name} in the second half: {half[-1] / half[0] - 1:+.1%}, between {min(half):.1f} and {max(half):.1f}")
    print(f"received {received:.0f}, lost {lost:.0f}")


main()
