#!/usr/bin/env bash
# With the credentials of deploy/security/make-credentials a fleet works, and nobody else can publish a model,
# ask, or listen. Prints a table of the attacks. Those with recorded packets need root.
set -euo pipefail

source=$(cd "$(dirname "$0")/../.." && pwd)
built=${TELLTALE_BUILT:-$source/build/release}
telltaled=$built/service/telltaled
telltale=$built/client/telltale
make=$source/deploy/security/make-credentials
packets=$source/tests/network/packets.py
[[ -n $(find /usr/lib -name libdds_security_auth.so -print -quit) ]] || exit 77
folder=$(mktemp -d)
daemons=()
stop() {
  for daemon in "${daemons[@]}"; do kill "$daemon" 2> /dev/null || true; done
  wait
  rm -rf "$folder"
}
trap stop EXIT
export TELLTALE_DDS_TAG="security-$$" TELLTALE_DOMAIN=63

fail() {
  echo "security_test: $1" >&2
  cat "$folder"/*.log >&2
  exit 1
}
expect_code() {  # CODE COMMAND...
  local code=0
  "${@:2}" > "$folder/out" 2>&1 || code=$?
  [[ $code == "$1" ]] || { cat "$folder/out" >&2; fail "exit $code, not $1: ${*:2}"; }
}
plain="file://$source/deploy/cyclonedds/loopback.xml"
of() {  # PARTICIPANT: its configuration
  echo "$plain,file://$folder/$1/security.xml"
}
as() {  # PARTICIPANT COMMAND...
  CYCLONEDDS_URI=$(of "$1") "${@:2}"
}
without() {
  CYCLONEDDS_URI=$plain "$@"
}
serve() {  # NAME CONFIGURATION: a daemon of this name, serving
  sed "s|^domain:.*|domain: 63|; s|^state_directory:.*|state_directory: \"$folder/state-$1\"|" \
    "$folder/daemon.textproto" > "$folder/$1.textproto"
  CYCLONEDDS_URI=$2 "$telltaled" --config "$folder/$1.textproto" > "$folder/$1.log" 2>&1 &
  daemons+=($!)
  for _ in $(seq 100); do
    grep -q "serving" "$folder/$1.log" && return
    kill -0 "${daemons[-1]}" 2> /dev/null || return 0
    sleep 0.1
  done
  fail "$1 does not serve"
}

survived() {  # ATTACK WHAT-WAS-SEEN: the daemon still answers
  kill -0 "${daemons[0]}" 2> /dev/null || fail "the daemon has ended: $1"
  expect_code 0 as fleet/client "$telltale" list
  outcomes+=("| $1 | $2 |")
}
accepted() {  # VEHICLE: how many of its samples the daemon has taken
  as fleet/client "$telltale" monitor --once --json --vehicle-id "$1" | grep -o '"accepted":[0-9]*' | cut -d: -f2
}
outcomes=()

"$telltale" load --boats 1 --write-vehicles "$folder/boats" > /dev/null
cat > "$folder/daemon.textproto" <<TEXT
domain: 63
state_directory: "x"
require_partition: true
vehicle_files: "$source/deploy/sample/yellowfish.textproto"
vehicle_folder: "$folder/boats"
announced { admit: "other" admit: "third" admit: "load-*" }
TEXT
for boat in other third; do
  sed "s/vehicle_id:.*/vehicle_id: \"$boat\"/" "$source/deploy/sample/yellowfish.textproto" > "$folder/$boat.textproto"
done

# Wrong use.
expect_code 2 "$make" --daemon d
expect_code 2 "$make" --out "$folder/x"
expect_code 2 "$make" --out "$folder/x" --boat "two words"
expect_code 2 "$make" --out "$folder/x" --boat b --days never

# The authority is older than the credentials that have expired.
faketime "3 days ago" "$make" --out "$folder/fleet" --daemon daemon --boat yellowfish --boat other > /dev/null
faketime "2 days ago" "$make" --out "$folder/fleet" --client expired --days 1 > /dev/null
"$make" --out "$folder/fleet" --client client > /dev/null  # added later
"$make" --out "$folder/rogue" --daemon daemon --client client > /dev/null
[[ $(stat -c %a "$folder/fleet/daemon/key.pem") == 600 ]] || fail "others can read a key"

serve secured "$(of fleet/daemon)"
expect_code 0 as fleet/client "$telltale" list
replay=("$telltale" replay --log "$source/deploy/sample" --vehicle-id yellowfish --speed 200)
recording=
if ((EUID == 0)); then
  recording=$folder/recording
  # Domain 63, participant 0: discovery and data.
  "$packets" record --port 23160 23161 --seconds 8 --out "$recording" > "$folder/recorded" &
  recorder=$!
fi
expect_code 0 as fleet/yellowfish "${replay[@]}"
expect_code 0 as fleet/client "$telltale" identify --vehicle-id yellowfish
expect_code 0 as fleet/client "$telltale" watch --all --count 1 --timeout 30
grep -q "revision 1" "$folder/out" || fail "the model does not reach a client"

# A boat may not ask; who has no credentials, or those of another authority, finds no daemon.
expect_code 1 as fleet/yellowfish "$telltale" list --timeout 4
survived "a boat that asks" "it may not; the client ends with 1"
expect_code 1 without "$telltale" list --timeout 4
survived "a client without credentials" "finds no daemon"
expect_code 1 as rogue/client "$telltale" list --timeout 4
survived "a client of another authority" "finds no daemon"

# Expired: the holder finds out, and the daemon too where the clock of the holder is wrong.
expect_code 1 as fleet/expired "$telltale" list --timeout 4
grep -q "expired" "$folder/out" || fail "expired credentials are not called so"
export FAKETIME_DONT_FAKE_MONOTONIC=1
expect_code 0 as fleet/client faketime "1 hour" "$telltale" list
expect_code 1 as fleet/expired faketime "36 hours ago" "$telltale" list --timeout 4
grep -q "no daemon answers" "$folder/out" || fail "expired credentials fail otherwise than by the daemon"
survived "a client whose credentials have expired" "cannot join; with a clock of the day before it finds no daemon"

# Telemetry of another boat: outside its own partition a boat cannot write, and within it the daemon sees whose it is.
before=$(accepted yellowfish)
expect_code 1 as fleet/other "${replay[@]}"
[[ $(accepted yellowfish) == "$before" ]] || fail "a boat sends telemetry of another"
expect_code 0 as fleet/other "$telltale" load --boats 1 --duration 2
as fleet/client "$telltale" monitor --once > "$folder/out"
foreign=$(tr -s '\n ' ' ' < "$folder/out" | { grep -oE '[0-9]+ FOREIGN_WRITER' || true; } | awk '{ sum += $1 } END { print sum + 0 }')
((foreign > 0)) || { cat "$folder/out" >&2; fail "samples of another boat are not counted"; }
[[ $(accepted load-00001) == 0 ]] || fail "a boat sends telemetry of another, by its own partition"
survived "a boat that sends telemetry of another" "cannot write in its partition; by its own, $foreign samples are counted as FOREIGN_WRITER"

# A boat announces itself and no other, neither in the other's partition nor in that of all.
announce() {  # BOAT
  echo "$telltale replay --log $source/deploy/sample --speed 1000 --timeout 6 --announce $folder/$1.textproto"
}
read -ra itself <<< "$(announce other)"
read -ra another <<< "$(announce third)"
expect_code 0 as fleet/other "${itself[@]}"
expect_code 1 as fleet/other "${another[@]}"
expect_code 1 as fleet/other "$telltale" load --boats 2 --announce --duration 1 --timeout 6
grep -q "announcement refused: FOREIGN_WRITER 'load-00002'" "$folder/secured.log" ||
  fail "the announcement of another boat is not counted"
as fleet/client "$telltale" list > "$folder/out"
grep -q "^other " "$folder/out" || fail "a boat that announces itself is not served"
if grep -qE "^(third|load-00002) " "$folder/out"; then fail "a boat announces another"; fi
survived "a boat that announces another" "cannot write in its partition; in that of all it is a FOREIGN_WRITER"
expect_code 0 as fleet/client "$telltale" retire --vehicle-id other

if [[ -n $recording ]]; then
  wait "$recorder"
  [[ $(< "$folder/recorded") -gt 100 ]] || fail "only $(< "$folder/recorded") packets were recorded"
  before=$(accepted yellowfish)
  sent=$("$packets" replay --file "$recording" --times 3)
  [[ $(accepted yellowfish) == "$before" ]] || fail "replayed packets are taken"
  survived "$sent recorded packets sent again" "0 samples are taken"
  sent=$("$packets" flood --port 23160 23161 --packets 100000 --seed 1 --file "$recording")
  lines=$(wc -l < "$folder/secured.log")
  ((lines < 200)) || fail "a flood writes $lines lines"
  survived "$sent malformed packets" "the log has $lines lines"
fi

# Models of others: a boat cannot publish any, and those of strangers are not seen.
expect_code 1 as fleet/yellowfish "$telltaled" --config "$folder/secured.textproto"
sed "s|state-secured|state-boat|" "$folder/secured.textproto" > "$folder/boat.textproto"
expect_code 1 as fleet/yellowfish "$telltaled" --config "$folder/boat.textproto"
grep -qi "creating a writer\|not allowed\|security" "$folder/out" || fail "a boat's daemon says not why it ends"
survived "a boat that publishes models" "cannot"
stranger() {  # NAME CONFIGURATION: a daemon that publishes revision 999 from the start
  mkdir "$folder/state-$1"
  python3 - "$folder/state-secured/models.sqlite" "$folder/state-$1/models.sqlite" <<'PYTHON'
import sqlite3, sys
copy = sqlite3.connect(sys.argv[2])
sqlite3.connect(sys.argv[1]).backup(copy)
copy.execute("UPDATE models SET revision = 999")
copy.commit()
PYTHON
  serve "$@"
  grep -q "published revision 999" "$folder/$1.log" || fail "the stranger publishes nothing"
  expect_code 0 as fleet/client "$telltale" watch --all --count 1 --timeout 30
  grep -q "revision 1" "$folder/out" || fail "a stranger's model is seen"
  expect_code 0 as fleet/client "$telltale" list
}
stranger plain "$plain"
survived "a model of revision 999 without credentials" "no client sees it"
stranger rogue "$(of rogue/daemon)"
survived "a model of revision 999 of another authority" "no client sees it"
printf '| attack | outcome |\n|---|---|\n'
printf '%s\n' "${outcomes[@]}"
echo "security_test: passed"
