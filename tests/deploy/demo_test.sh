#!/usr/bin/env bash
# deploy/demo shows the boat's model and its scores, prints the same again on a busy machine, and leaves nothing
# running or lying about: neither at its end nor when it is interrupted. TELLTALE_BUILT names the build folder.
set -euo pipefail
# shellcheck source=tests/deploy/running_demo.bash
source "$(dirname "${BASH_SOURCE[0]}")/running_demo.bash"
busy=()
stop_busy() {
  for pid in "${busy[@]}"; do kill "$pid" 2> /dev/null || true; done
  busy=()
}
trap 'stop_busy; stop_demo; rm -rf "$sandbox"' EXIT

# interrupted SIGNAL STATUS: once the replay has begun, the signal ends it all with that status.
interrupted() {
  begin_demo
  await_line 'becomes live telemetry'
  [[ -n $(left_over) ]] || fail "the daemon should be running by now"
  kill -s "$1" "$demo"
  local status=0
  wait "$demo" || status=$?
  ((status == $2)) || fail "SIG$1 should end it with $2, not $status"
  check_nothing_is_left
}

begin_demo
wait "$demo" || fail "it exited $?"
for shown in SURGE SWAY YAW 'one step' 'free run'; do
  grep -qi -- "$shown" "$output" || fail "nothing is said about $shown"
done
# The surge thrust of one propeller in the paper's table: 2 a_f = -0.0145 and 2 b_f = 0.1403 per 0.2 s.
awk -v a=-0.03625 -v b=0.35075 '
  function near(x, truth) { return (x - truth) ^ 2 <= (0.25 * truth) ^ 2 }
  $1 == "f:d^2" && !seen_a++ { good_a = near($5, a) }
  $1 == "f:d" && !seen_b++ { good_b = near($5, b) }
  END { exit !(good_a && good_b) }' "$output" ||
  fail "a surge thrust coefficient is more than 25 % off the paper's table"
grep -q ', all received$' "$output" || fail "the replay lost samples"
check_nothing_is_left

# Two busy loops beside it leave the daemon and the replay less than half of two cores.
cp "$output" "$sandbox/first"
for _ in 1 2; do
  while :; do :; done &
  busy+=($!)
done
begin_demo
wait "$demo" || fail "on a busy machine it exited $?"
stop_busy
diff "$sandbox/first" "$output" || fail "it printed something else on a busy machine"
check_nothing_is_left

interrupted INT 130
interrupted TERM 143

echo "the demo shows what it should, twice the same, and cleans up after itself"
