#!/usr/bin/env bash
# The mappings of deploy/mappings on recordings as the systems make them, by writers of other programs: what comes
# back is the log, sample by sample.
set -euo pipefail
# shellcheck source=tests/deploy/foreign_fixtures.bash
source "$(dirname "${BASH_SOURCE[0]}")/foreign_fixtures.bash"
make_fixtures 60
node "$writers/write_systems.mjs" "$work/log" "$work/made"
"$foreign/write_ros1.py" "$work/log" "$work/made"

# comes_back FILE MAPPING PULSE_STEP [OPTION...]: the steps are those of ROS, or what the options say.
comes_back() {
  "$telltale" import --log "$work/made/$1" --map "$root/deploy/mappings/$2.textproto" --out "$work/read/$1" \
    > /dev/null 2> "$work/said" || { echo "FAILED: import of $1 by $2" >&2; cat "$work/said" >&2; exit 1; }
  "$foreign/same_samples.py" "$work/log" "$work/read/$1" "${@:3}" || { cat "$work/said" >&2; exit 1; }
}
ros=(--epoch 1700000000 --steps 1e-6 1e-9 1e-6)
comes_back mavros.mcap mavros "${ros[@]}" 1
comes_back mavros-ros1.bag mavros "${ros[@]}" 1
comes_back ardupilot.mcap ardupilot "${ros[@]}" 1
comes_back vrx.mcap vrx "${ros[@]}" 1e-3
comes_back heron.bag heron "${ros[@]}" 1e-3
comes_back blueos.mcap blueos --steps 1e-3 1e-7 4e-5 1
echo "the mappings give 6 recordings of 5 systems back sample by sample"
