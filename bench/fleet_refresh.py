#!/usr/bin/env python3
"""What a refresh of a fleet takes: docs/validation/reliability.md.

  fleet_refresh.py [--boats N] [--recorded S]

`telltale load` sends so many seconds of each boat's telemetry, then `telltale refresh --all` identifies every boat. Prints
the time of the refresh, and its ratio to the computing alone: the times in which the daemon worked on a boat, as its log
has them. TELLTALE_BUILT names the build folder.
"""
import re
import time

from daemon_under_load import Fleet, given_arguments

WORKED_ON = re.compile(r"identification of (load-\d+) for \S+: (\w+) in ([0-9.]+) s")


def main():
    given = given_arguments(__doc__, boats=1000, recorded=600.0)
    with Fleet(given.boats) as fleet:
        fleet.await_telemetry()
        time.sleep(given.recorded)
        fleet.load.terminate()
        fleet.load.wait()
        begun, cpu_s = time.monotonic(), fleet.cpu_s()
        fleet.telltale("refresh", "--all")
        took_s, cpu_s = time.monotonic() - begun, fleet.cpu_s() - cpu_s
        worked = WORKED_ON.findall(fleet.log())
    computing_s = sum(float(seconds) for _, _, seconds in worked)
    outcomes = {outcome: sum(one == outcome for _, one, _ in worked) for outcome in sorted({one for _, one, _ in worked})}
    print(f"{given.boats} boats of {given.recorded:.0f} s: refreshed in {took_s:.1f} s, {cpu_s:.1f} s of processor time; "
          f"computing alone {computing_s:.1f} s, ratio {took_s / computing_s:.2f}\n{len(worked)} in the log: {outcomes}")


main()
