#!/usr/bin/env bash
# Recordings that are odd, though nothing in them is wrong: each opens as it is and comes back sample by sample, or is
# refused for a reason that says what to do.
set -euo pipefail
# shellcheck source=tests/deploy/foreign_fixtures.bash
source "$(dirname "${BASH_SOURCE[0]}")/foreign_fixtures.bash"
make_fixtures 120
node "$writers/write_odd_recordings.mjs" "$work/log" "$work/made"
"$foreign/write_odd_recordings.py" "$work/log" "$work/made"

fail() {
  echo "FAILED: $1" >&2
  cat "$work/said" >&2
  exit 1
}
# opens FILE PHRASE [OPTION...]: check, import and identify take it, and say so.
opens() {
  "$telltale" check --log "$work/made/$1" "${@:3}" > "$work/said" 2>&1 || fail "check of $1"
  tr -s '\n ' ' ' < "$work/said" | grep -qF -- "$2" || fail "check of $1 does not say: $2"
  "$telltale" import --log "$work/made/$1" "${@:3}" --out "$work/read/$1" > "$work/said" 2>&1 || fail "import of $1"
  "$telltale" identify --log "$work/made/$1" "${@:3}" --vehicle "$work/$vehicle.textproto" --structure static \
    --seed 1 --out "$work/model.json" > "$work/said" 2>&1 || fail "identify from $1"
}
# comes_back FILE STEP... [OPTION...]: what import wrote is the log.
comes_back() {
  "$foreign/same_samples.py" "$work/log" "$work/read/$1" "${@:2}" 2> "$work/said" || fail "$1 comes back"
}
# is_refused FILE PHRASE [OPTION...]
is_refused() {
  if "$telltale" check --log "$work/made/$1" "${@:3}" > "$work/said" 2>&1; then fail "check takes $1"; fi
  tr -s '\n ' ' ' < "$work/said" | grep -qF -- "$2" || fail "check of $1 does not say: $2"
}
sed 's/starboard .*/starboard { neutral_us: 1500 full_forward_us: 1100 full_reverse_us: 1900 }/' \
  "$root/deploy/sample/yellowfish.textproto" > "$work/reversed.textproto"
cp "$root/deploy/sample/yellowfish.textproto" "$work/usual.textproto"
mavlink=(--steps 1e-3 1e-7 4e-5 1)

vehicle=reversed
opens two-gps.tlog "positions from GPS_RAW_INT; heading from ATTITUDE; outputs 1 (port) and 3 (starboard)"
vehicle=usual
opens filtered-only.tlog "positions from GLOBAL_POSITION_INT; heading from GLOBAL_POSITION_INT"
opens slow-outputs.tlog "SERVO_OUTPUT_RAW comes at 2.0 Hz only: set SR0_RC_CHAN to 10"
opens disarmed.tlog "thrusters 200 OUT_OF_RANGE rejected"
opens clock-set.tlog "positions from GPS_RAW_INT"
comes_back clock-set.tlog "${mavlink[@]}"
opens bare.rlog "positions from GPS_RAW_INT"
comes_back bare.rlog "${mavlink[@]}"
opens slashed-blueos.mcap "heading from ATTITUDE"
comes_back slashed-blueos.mcap "${mavlink[@]}"
opens power-off.bin "positions from GPS instance 0; heading from ATT; 1 corrupt records"
opens european.csv "positions from Breite and Länge" --map "$work/made/european.textproto"
comes_back european.csv --epoch 1700000000 --steps 1e-6 1e-9 1e-6 1e-3
opens iso.csv "positions from lat and lon" --map "$work/made/iso.textproto"
comes_back iso.csv --epoch 1700000000 --steps 1e-6 1e-9 1e-6 1e-3
opens odometry.mcap "metres from an origin that is not stated" --map "$work/made/odometry.textproto"

# A name says nothing, nor does what wraps a file.
cp "$work/made/clock-set.tlog" "$work/made/renamed.bin"
gzip -c "$work/made/clock-set.tlog" > "$work/made/wrapped.tlog.gz"
gzip -c "$work/made/iso.csv" > "$work/made/wrapped.csv.gz"
opens renamed.bin "positions from GPS_RAW_INT"
opens wrapped.tlog.gz "positions from GPS_RAW_INT"
comes_back wrapped.tlog.gz "${mavlink[@]}"
opens wrapped.csv.gz "positions from lat and lon" --map "$work/made/iso.textproto"

# What cannot be taken says why, and what to do.
mkdir "$work/made/several"
cp "$work/made/clock-set.tlog" "$work/made/two-gps.tlog" "$work/made/several"
: > "$work/made/nothing.tlog"
printf '\x89MCAP0\r\n' > "$work/made/magic.mcap"
is_refused several "holds 2 recordings: clock-set.tlog, two-gps.tlog -> give each of them by a --log of its own"
is_refused nothing.tlog "is empty"
is_refused magic.mcap "Missing, gnss: no position with a fix"
is_refused iso.csv "seems to be a CSV file, which begins with time,lat,lon,heading,left,right"
is_refused odometry.mcap 'If they are newtons, a mapping such as deploy/mappings/vrx.textproto says with unit: "N"'
echo "14 odd recordings open, 5 are refused for their reason"
