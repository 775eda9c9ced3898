#!/usr/bin/env bash
# With the credentials of deploy/security/make-credentials a fleet works, and nobody else can publish a model,
# ask, or listen.
set -euo pipefail

source=$(cd "$(dirname "$0")/../.." && pwd)
built=${TELLTALE_BUILT:-$source/build/release}
telltaled=$built/service/telltaled
telltale=$built/client/telltale
make=$source/deploy/security/make-credentials
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

cat > "$folder/daemon.textproto" <<TEXT
domain: 63
state_directory: "x"
vehicle_files: "$source/deploy/sample/yellowfish.textproto"
TEXT

# Wrong use.
expect_code 2 "$make" --daemon d
expect_code 2 "$make" --out "$folder/x"
expect_code 2 "$make" --out "$folder/x" --boat "two words"
expect_code 2 "$make" --out "$folder/x" --boat b --days never

"$make" --out "$folder/fleet" --daemon daemon --boat boat > /dev/null
"$make" --out "$folder/fleet" --client client > /dev/null  # added later
"$make" --out "$folder/rogue" --daemon daemon --client client > /dev/null
[[ $(stat -c %a "$folder/fleet/daemon/key.pem") == 600 ]] || fail "others can read a key"

serve secured "$(of fleet/daemon)"
expect_code 0 as fleet/client "$telltale" list
expect_code 0 as fleet/boat "$telltale" replay --log "$source/deploy/sample" --vehicle-id yellowfish --speed 200
expect_code 0 as fleet/client "$telltale" identify --vehicle-id yellowfish
expect_code 0 as fleet/client "$telltale" watch --all --count 1 --timeout 30
grep -q "revision 1" "$folder/out" || fail "the model does not reach a client"

# A boat may not ask; who has no credentials, or those of another authority, finds no daemon.
expect_code 1 as fleet/boat "$telltale" list --timeout 4
expect_code 1 without "$telltale" list --timeout 4
expect_code 1 as rogue/client "$telltale" list --timeout 4

# Models of others: a boat cannot publish any, and those of strangers are not seen.
expect_code 1 as fleet/boat "$telltaled" --config "$folder/secured.textproto"
sed "s|state-secured|state-boat|" "$folder/secured.textproto" > "$folder/boat.textproto"
expect_code 1 as fleet/boat "$telltaled" --config "$folder/boat.textproto"
grep -qi "creating a writer\|not allowed\|security" "$folder/out" || fail "a boat's daemon says not why it ends"
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
stranger rogue "$(of rogue/daemon)"
echo "security_test: passed"
