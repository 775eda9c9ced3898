#!/usr/bin/env python3
"""What taking in telemetry costs beside taking it from the bus alone: docs/validation/reliability.md.

  ingest_beside_raw.py [--boats N] [--seconds S]

`telltale load` sends to telltaled and to raw_reader at once. The raw reader does nothing with what it takes. Prints the
processor time a sample of each, and the ratio. TELLTALE_BUILT names the build folder.
"""
import subprocess

from daemon_under_load import BUILT, DOMAIN, Fleet, given_arguments, loopback_environment


def beside_each_other(boats, seconds):
    """Processor seconds a sample of telltaled and of the raw reader."""
    name = "telltale_received_samples_total"
    with Fleet(boats) as fleet:
        fleet.await_telemetry()
        received, cpu_s = fleet.total(name), fleet.cpu_s()
        said = subprocess.run([BUILT / "bench/raw_reader", DOMAIN, str(seconds)], env=loopback_environment(), check=True,
                              stdout=subprocess.PIPE, text=True).stdout
        received, cpu_s = fleet.total(name) - received, fleet.cpu_s() - cpu_s
        print(f"packets that the kernel dropped before telltaled: {fleet.dropped_packets()}")
    taken, lost, raw_cpu_s = map(float, said.split())
    print(f"raw reader: {taken / seconds:.0f} samples/s, lost {lost:.0f}")
    return cpu_s / received, raw_cpu_s / taken


def main():
    given = given_arguments(__doc__, boats=1000, seconds=60.0)
    daemon, raw = beside_each_other(given.boats, given.seconds)
    print(f"{given.boats} boats: telltaled {1e6 * daemon:.2f} us a sample, raw reader {1e6 * raw:.2f} us: ratio "
          f"{raw / daemon:.0%}")


main()
