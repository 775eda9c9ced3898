#!/usr/bin/env python3
"""Whether a daemon grows over days: docs/validation/reliability.md.

  soak.py [--boats N] [--speed X] [--minutes M]

`telltale load` sends the telemetry of boats whose clocks run X times as fast, and one boat is identified again and again.
Prints the daemon's memory, descriptors and store as time goes on, and how far each grew in the second half.
TELLTALE_BUILT names the build folder.
"""
import time

from daemon_under_load import Fleet, given_arguments

LINES = 20


def main():
    given = given_arguments(__doc__, boats=10, speed=50, minutes=10.0)
    seconds = 60 * given.minutes
    with Fleet(given.boats, load_options=("--speed", str(given.speed))) as fleet:
        fleet.await_telemetry()
        begun, identified, seen = time.monotonic(), 0, []
        print("hours of data | resident MB | descriptors | store MB | identifications")
        for line in range(1, LINES + 1):
            answers = fleet.identify_in_turn(1, begun + seconds * line / LINES)
            identified += sum(code == 0 for code, _ in answers)
            seen.append((fleet.resident_bytes() / 1e6, fleet.open_descriptors(), fleet.stored_bytes() / 1e6))
            hours = (time.monotonic() - begun) * given.speed / 3600
            print(f"{hours:.1f} | {seen[-1][0]:.0f} | {seen[-1][1]} | {seen[-1][2]:.1f} | {identified}", flush=True)
        received, lost = (fleet.total(f"telltale_{name}_total") for name in ("received_samples", "vehicle_samples_lost"))
    for name, values in zip(("resident memory", "descriptors", "store"), zip(*seen)):
        half = values[LINES // 2 - 1:]
        print(f"{name} in the second half: {half[-1] / half[0] - 1:+.1%}, between {min(half):.1f} and {max(half):.1f}")
    print(f"received {received:.0f}, lost {lost:.0f}")


main()
