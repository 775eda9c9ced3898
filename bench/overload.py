#!/usr/bin/env python3
"""What a daemon does that is sent more than it takes in: docs/validation/reliability.md.

  overload.py [--boats N] [--times N] [--seconds S]

`telltale load` sends each boat's telemetry so many times, and telltaled takes in what the boats send usually. Meanwhile
boats are identified one after another, beside a refresh of the fleet, which begins again once it has ended. Prints
what became of the samples, the memory at the beginning and at the end, and how long an identification took, from the
start of the command to its end.
TELLTALE_BUILT names the build folder.
"""
import math
import threading
import time

from daemon_under_load import Fleet, given_arguments

USUAL_PER_S = 65


def refresh_again_and_again(fleet, ended, refreshes):
    """Until `ended` is set. Adds the exit code of each to `refreshes`."""
    while not ended.is_set():
        refreshes.append(fleet.begin("refresh", "--all").wait())


def quantile(values, share):
    return sorted(values)[math.ceil(share * len(values)) - 1]


def main():
    given = given_arguments(__doc__, boats=100, times=5, seconds=120.0)
    bound = f"intake {{ samples_per_s: {USUAL_PER_S * given.boats} }}"
    with Fleet(given.boats, settings=bound, load_options=("--times", str(given.times))) as fleet:
        fleet.await_telemetry()
        time.sleep(60)  # what an identification needs
        begun, resident, cpu_s = time.monotonic(), fleet.resident_bytes(), fleet.cpu_s()
        ended, refreshes = threading.Event(), []
        threading.Thread(target=refresh_again_and_again, args=(fleet, ended, refreshes), daemon=True).start()
        answers = fleet.identify_in_turn(given.boats, begun + given.seconds)
        ended.set()
        cores = (fleet.cpu_s() - cpu_s) / (time.monotonic() - begun)
        resident = (resident, fleet.resident_bytes())
        names = ("accepted", "rejected", "shed", "lost")
        counts = {name: fleet.total(f"telltale_vehicle_samples_{name}_total") for name in names}
        received, dropped = fleet.total("telltale_received_samples_total"), fleet.dropped_packets()
        by_channel = {channel: fleet.total(f'telltale_vehicle_samples_shed_total.*channel="{channel}"')
                      for channel in ("heading", "gnss", "thrusters")}
    print(f"{given.boats} boats, {given.times} times as much: {cores:.2f} cores; received {received:.0f}; packets that the "
          f"kernel dropped {dropped}")
    print(", ".join(f"{name} {count:.0f}" for name, count in counts.items()))
    print("shed by channel: " + ", ".join(f"{channel} {count:.0f}" for channel, count in by_channel.items()))
    print(f"resident {resident[0] / 1e6:.0f} MB, {given.seconds:.0f} s later {resident[1] / 1e6:.0f} MB")
    print(f"refreshes that have ended: {len(refreshes)}")
    took_s = [seconds for _, seconds in answers]
    unanswered = sum(code not in (0, 3) for code, _ in answers)  # neither a model nor a refusal
    print(f"{len(took_s)} identifications, {unanswered} unanswered; seconds:", ", ".join(
        f"{name} {quantile(took_s, share):.2f}" for name, share in (("median", 0.5), ("90 %", 0.9), ("99 %", 0.99), ("worst", 1))))
    print(f"of them within 1 s: {sum(seconds <= 1 for seconds in took_s) / len(took_s):.1%}")


main()
