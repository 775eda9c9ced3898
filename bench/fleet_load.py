#!/usr/bin/env python3
"""What a daemon takes for many boats, and what it loses: docs/validation/reliability.md.

  fleet_load.py [--boats N] [--seconds S]

Starts telltaled and `telltale load` on this machine. Prints the processor time of telltaled, its memory, and the samples
that it took in and lost by their sequence numbers, with the packets that found its receive buffers full. TELLTALE_BUILT names the build folder.
"""

from daemon_under_load import Fleet, given_arguments


def main():
    given = given_arguments(__doc__, boats=1000, seconds=300.0)
    with Fleet(given.boats) as fleet:
        idle = fleet.resident_bytes()
        fleet.await_telemetry()
        cores = fleet.cores(given.seconds)
        received = fleet.total("telltale_received_samples_total")
        lost = fleet.total("telltale_vehicle_samples_lost_total")
        a_boat = (fleet.resident_bytes() - idle) / given.boats
        dropped = fleet.dropped_packets()
        print(f"{given.boats} boats, {given.seconds:.0f} s: {cores:.3f} cores, {received / given.seconds:.0f} samples/s\n"
              f"resident {fleet.resident_bytes() / 1e6:.0f} MB, {idle / 1e6:.0f} MB without boats: {a_boat / 1e6:.2f} MB a"
              f" boat\nreceived {received:.0f}, lost {lost:.0f} ({lost / (received + lost):.4%}); packets that the kernel dropped {dropped}")


main()
