#!/usr/bin/env bash
# Recordings that other programs' writers make of one telemetry log (@mcap/core, node-mavlink,
# @foxglove/rosmsg2-serialization, from npm) come back sample by sample.
set -euo pipefail
# shellcheck source=tests/deploy/foreign_fixtures.bash
source "$(dirname "${BASH_SOURCE[0]}")/foreign_fixtures.bash"
make_fixtures 120

for file in log.tlog blueos.mcap ros2-none.mcap ros2-unchunked.mcap ros2-zstd.mcap ros2-lz4.mcap; do
  "$telltale" import --log "$work/made/$file" --out "$work/read/$file" > /dev/null 2> "$work/said" ||
    { echo "FAILED: import of $file" >&2; cat "$work/said" >&2; exit 1; }
done
mkdir "$work/bag"
cp "$work/made/ros2-zstd.mcap" "$work/bag/bag_0.mcap"
"$telltale" import --log "$work/bag" --out "$work/read/bag" > /dev/null 2> "$work/said"

# What a mapping names is what is found without one.
cat > "$work/ros2.textproto" <<'MAPPING'
time { field: "header.stamp" unit: "stamp" }
positions { topic: "/gps/*" latitude: "latitude" longitude: "longitude" }
headings { topic: "/imu/data" field: "orientation" unit: "quaternion" frame: "ENU" }
port { topic: "/mavros/rc/out" field: "channels[0]" }
starboard { topic: "/mavros/rc/out" field: "channels[2]" }
MAPPING
mapped() {
  "$telltale" import --log "$work/made/$1" --map "$2" --out "$work/read/mapped-$1" > /dev/null 2> "$work/said" ||
    { echo "FAILED: import of $1 by $2" >&2; cat "$work/said" >&2; exit 1; }
}
mapped blueos.mcap "$root/deploy/mappings/blueos.textproto"
mapped ros2-zstd.mcap "$work/ros2.textproto"

python3 - "$work" <<'PYTHON'
import csv, pathlib, sys

work = pathlib.Path(sys.argv[1])
EPOCH_S = 1700000000.0  # of write_fixtures.mjs
HALF_DIGIT = 0.5 + 1e-6


def read(folder, channel):
    with open(folder / f"{channel}.csv", newline="") as file:
        rows = list(csv.reader(file))[1:]
    return [[float(cell) for cell in row] for row in rows]


def turn(degrees):
    return (degrees + 180.0) % 360.0 - 180.0


# Resolution of each format: time (s), position (deg), heading (deg), pulse (us). MAVLink: fixes and
# outputs in microseconds, attitude in milliseconds and single precision, positions in 1e-7 degrees.
# All write whole microseconds of pulse.
MAVLINK = {"gnss": (1e-6, 1e-7), "heading": (1e-3, 4e-5), "thrusters": (1e-6, 1.0)}
ROS2 = {"gnss": (1e-6, 1e-12), "heading": (1e-6, 1e-9), "thrusters": (1e-6, 1.0)}
faults = []
for folder in sorted((work / "read").iterdir()):
    of_mavlink = folder.name.endswith(("log.tlog", "blueos.mcap"))
    for channel, (second, unit) in (MAVLINK if of_mavlink else ROS2).items():
        wanted, got = read(work / "log", channel), read(folder, channel)
        if len(wanted) != len(got):
            faults.append(f"{folder.name}: {channel}: {len(got)} samples of {len(wanted)}")
            continue
        for row, (w, g) in enumerate(zip(wanted, got)):
            time = g[0] if of_mavlink else g[0] - EPOCH_S
            apart = [turn(a - b) if channel == "heading" else a - b for a, b in zip(w[1:], g[1:])]
            if abs(time - w[0]) > HALF_DIGIT * second or any(
                    abs(value) > HALF_DIGIT * unit for value in apart):
                faults.append(f"{folder.name}: {channel}, row {row}: wrote {w}, read {g}")
                break
for fault in faults:
    print("FAILED:", fault, file=sys.stderr)
sys.exit(1 if faults else 0)
PYTHON

# What differs by compression or container alone is the same to the last digit, and so is its model.
for same in ros2-unchunked.mcap ros2-zstd.mcap ros2-lz4.mcap mapped-ros2-zstd.mcap bag; do
  diff -r "$work/read/ros2-none.mcap" "$work/read/$same" > /dev/null ||
    { echo "FAILED: $same differs from ros2-none.mcap" >&2; exit 1; }
done
echo "9 recordings of other writers come back sample by sample"
