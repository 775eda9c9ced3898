#!/usr/bin/env bash
# One recording gives the same model through every format, to the last digit that the format resolves.
set -euo pipefail
# shellcheck source=tests/deploy/foreign_fixtures.bash
source "$(dirname "${BASH_SOURCE[0]}")/foreign_fixtures.bash"
make_fixtures 300
"$root/tests/client/recording/foreign/other_formats.py" "$work/log" "$work/made"
cp -r "$work/log" "$work/made/log"
mkdir "$work/models"

cat > "$work/one-csv.textproto" <<'MAPPING'
time { field: "stamp" }
positions { latitude: "lat" longitude: "lon" }
headings { field: "hdg" }
port { field: "pwm_left" }
starboard { field: "pwm_right" }
MAPPING

identify() {
  local name=${1//\//-}
  "$telltale" identify --log "$work/made/$1" --vehicle "$root/deploy/sample/yellowfish.textproto" \
    --structure static --seed 1 --out "$work/models/$name.json" "${@:2}" > /dev/null 2> "$work/said" ||
    { echo "FAILED: identify from $1" >&2; cat "$work/said" >&2; exit 1; }
}
identify log
identify one.csv --map "$work/one-csv.textproto"
for format in ros2-{none,unchunked,zstd,lz4}.mcap ros2.db3 split ros1-{none,bz2,lz4}.bag \
  resolved/mavlink log.tlog blueos.mcap resolved/dataflash log.bin; do
  identify "$format"
done

python3 - "$work/models" <<'PYTHON'
import json, math, pathlib, sys

models = {}
for file in pathlib.Path(sys.argv[1]).iterdir():
    model = json.loads(file.read_text())
    for recording in model["provenance"]["recordings"]:
        del recording["name"]  # of the file
    models[file.stem] = model
faults = []

# Formats that hold the same numbers, the log itself among them, give the same model in every digit of the file.
for first, *others in (["log", "one.csv"],
                       ["ros2-none.mcap", "ros2-unchunked.mcap", "ros2-zstd.mcap", "ros2-lz4.mcap", "ros2.db3",
                        "split", "ros1-none.bag", "ros1-bz2.bag", "ros1-lz4.bag"],
                       ["resolved-mavlink", "log.tlog", "blueos.mcap"], ["resolved-dataflash", "log.bin"]):
    faults += [f"the model of {other} is not that of {first}" for other in others if models[other] != models[first]]

# What a format rounds is an error beside the sensors' own. An error of RATIO times their noise moves an estimate by
# RATIO standard errors, one sigma. A round step is uniform: its sigma is its width over the root of 12.
NOISE_M, NOISE_RAD = 0.01, math.radians(0.2)  # deploy/sample/README.md
FASTEST_MPS, FASTEST_RADPS = 1.5, 1.0  # docs/reference/yellowfish-twin.md
M_PER_DEGREE = 111320.0


def ratio(degree_step, second_step):
    position_m = math.hypot(degree_step * M_PER_DEGREE, second_step * FASTEST_MPS)
    return max(position_m / NOISE_M, second_step * FASTEST_RADPS / NOISE_RAD) / math.sqrt(12.0)


MAVLINK = ratio(1e-7, 1e-6)  # the log's headings are at whole milliseconds
ROS2 = ratio(0.0, math.ulp(1.7e9))  # doubles hold times since 1970 to 0.24 us
FOUR_SIGMA = 4.0
for name, expected in (("ros2-none.mcap", ROS2), ("log.tlog", MAVLINK), ("log.bin", MAVLINK)):
    apart = max(abs(ours["estimate"] - theirs["estimate"]) / theirs["standardError"]
                for ours, theirs in zip(models[name]["coefficients"], models["log"]["coefficients"])
                if theirs["status"] == "ESTIMATED")
    print(f"{name}: the largest difference to the log's model is {apart:.2g} standard errors, "
          f"{FOUR_SIGMA * expected:.2g} allowed")
    if not apart <= FOUR_SIGMA * expected:
        faults.append(f"{name} differs by {apart} standard errors, more than {FOUR_SIGMA * expected}")
for fault in faults:
    print("FAILED:", fault, file=sys.stderr)
sys.exit(1 if faults else 0)
PYTHON
