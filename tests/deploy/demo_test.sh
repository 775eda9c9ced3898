#!/usr/bin/env bash
# deploy/demo shows the boat's model and its scores, prints the same again on a busy machine, and leaves nothing
# running or lying about: neither at its end nor when it is interrupted. TELLTALE_BUILT names the build folder.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
sandbox=$(mktemp -d)
busy=()
stop_busy() {
  for pid in "${busy[@]}"; do kill "$pid" 2> /dev/null || true; done
  busy=()
}
trap 'stop_busy; rm -rf "$sandbox"' EXIT
mkdir "$sandbox/tmp"
export TMPDIR=$sandbox/tmp
unset TELLTALE_DDS_TAG

fail() { echo "FAILED: $1" >&2; cat "$sandbox/output" >&2; exit 1; }

# start_demo: in the background, where a shell would have SIGINT ignored.
start_demo() {
  : > "$sandbox/output"
  env --default-signal=INT "$root/deploy/demo" --built "$TELLTALE_BUILT" &> "$sandbox/output" &
  demo=$!
}

# left_over: processes that carry the discovery tag of the demo just run.
left_over() {
  grep -lzx "TELLTALE_DDS_TAG=demo-$demo" /proc/[0-9]*/environ 2> /dev/null || true
}

expect_nothing_left() {
  [[ -z $(left_over) ]] || fail "$1, yet still running: $(left_over)"
  [[ -z $(ls -A "$TMPDIR") ]] || fail "$1, yet left behind: $(ls -A "$TMPDIR")"
}

# interrupted SIGNAL STATUS: once the replay has begun, the signal ends it all with that status.
interrupted() {
  start_demo
  until grep -q 'becomes live telemetry' "$sandbox/output"; do
    kill -0 "$demo" 2> /dev/null || fail "it ended before the replay began"
    sleep 0.05
  done
  [[ -n $(left_over) ]] || fail "the daemon should be running by now"
  kill -s "$1" "$demo"
  local status=0
  wait "$demo" || status=$?
  ((status == $2)) || fail "SIG$1 should end it with $2, not $status"
  expect_nothing_left "stopped by SIG$1"
}

start_demo
wait "$demo" || fail "it exited $?"
for shown in SURGE SWAY YAW 'one step' 'free run'; do
  grep -qi -- "$shown" "$sandbox/output" || fail "nothing is said about $shown"
done
# The surge thrust of one propeller in the paper's table: 2 a_f = -0.0145 and 2 b_f = 0.1403 per 0.2 s.
awk -v a=-0.03625 -v b=0.35075 '
  function near(x, truth) { return (x - truth) ^ 2 <= (0.25 * truth) ^ 2 }
  $1 == "f:d^2" && !seen_a++ { good_a = near($5, a) }
  $1 == "f:d" && !seen_b++ { good_b = near($5, b) }
  END { exit !(good_a && good_b) }' "$sandbox/output" ||
  fail "a surge thrust coefficient is more than 25 % off the paper's table"
grep -q ', all received$' "$sandbox/output" || fail "the replay lost samples"
expect_nothing_left "come to its end"

# Two busy loops beside it leave the daemon and the replay less than half of two cores.
cp "$sandbox/output" "$sandbox/first"
for _ in 1 2; do
  while :; do :; done &
  busy+=($!)
done
start_demo
wait "$demo" || fail "on a busy machine it exited $?"
stop_busy
diff "$sandbox/first" "$sandbox/output" || fail "it printed something else on a busy machine"
expect_nothing_left "come to its end on a busy machine"

interrupted INT 130
interrupted TERM 143

echo "the demo shows what it should, twice the same, and cleans up after itself"
