#!/usr/bin/env python3
"""What taking in telemetry costs beside taking it from the bus alone: docs/validation/reliability.md.

  ingest_beside_raw.py [--boats N] [--seconds S]

`telltale load` sends to telltaled, then to raw_reader, which does nothing with what it takes. Prints the processor time
a sample of each, and the ratio. TELLTALE_BUILT names the build folder.
"""
import argparse
import subprocess

from daemon_under_load import BUILT, DOMAIN, Fleet, load_command, loopback_environment


def of_daemon(boats, seconds):
    with Fleet(boats) as fleet:
        fleet.await_telemetry()
        name = "telltale_received_samples_total"
        before = fleet.total(name)
        cores = fleet.cores(seconds)
        return cores * seconds / (fleet.total(name) - before)


def of_raw_reader(boats, seconds):
    environment = loopback_environment()
    load = subprocess.Popen([*load_command(boats), "--duration", "86400"], env=environment, stdout=subprocess.DEVNULL,
                            stderr=subprocess.DEVNULL)
    try:
        said = subprocess.run([BUILT / "bench/raw_reader", DOMAIN, str(seconds)], env=environment, check=True,
                              stdout=subprocess.PIPE, text=True).stdout
    finally:
        load.terminate()
        load.wait()
    taken, lost, cpu_s = map(float, said.split())
    print(f"raw reader: {taken / seconds:.0f} samples/s, lost {lost:.0f}")
    return cpu_s / taken


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--boats", type=int, default=1000)
    arguments.add_argument("--seconds", type=float, default=60)
    given = arguments.parse_args()
    daemon = of_daemon(given.boats, given.seconds)
    raw = of_raw_reader(given.boats, given.seconds)
    print(f"{given.boats} boats: telltaled {1e6 * daemon:.2f} us a sample, raw reader {1e6 * raw:.2f} us: ratio "
          f"{raw / daemon:.0%}")


main()
