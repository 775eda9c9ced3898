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

# MAVLink: fixes and outputs in microseconds, attitude in milliseconds and single precision, positions in 1e-7
# degrees. All write whole microseconds of pulse.
for read in "$work"/read/*; do
  steps=(--epoch 1700000000 --steps 1e-6 1e-12 1e-9 1)
  [[ $read == *log.tlog || $read == *blueos.mcap ]] && steps=(--steps 1e-3 1e-7 4e-5 1)
  "$foreign/same_samples.py" "$work/log" "$read" "${steps[@]}"
done

# What differs by compression or container alone is the same to the last digit, and so is its model.
for same in ros2-unchunked.mcap ros2-zstd.mcap ros2-lz4.mcap mapped-ros2-zstd.mcap bag; do
  diff -r "$work/read/ros2-none.mcap" "$work/read/$same" > /dev/null ||
    { echo "FAILED: $same differs from ros2-none.mcap" >&2; exit 1; }
done
echo "9 recordings of other writers come back sample by sample"
