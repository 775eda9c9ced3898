#!/usr/bin/env bash
# deploy/demo --fleet sees the clock that jumps once and the thruster that weakens, names the thruster by itself,
# finds nothing wrong with the others, shows it all on the page, and ends by itself with a summary. It is held up
# once it has seen everything, since its page lasts no longer than it.
set -euo pipefail
# shellcheck source=tests/deploy/running_demo.bash
source "$(dirname "${BASH_SOURCE[0]}")/running_demo.bash"

"$root/deploy/demo" --keep &> "$output" && fail "--keep without --fleet is taken"

modules=$built/tests/page
picture=true
"$root/tests/deploy/from_npm" "$root/tests/web" "$modules" chromium || {
  [[ ${CI-} != true ]] || exit 1
  picture=false
}

begin_demo --fleet
await_line 'boat-5: diagnosed'
kill -s STOP "$demo"

# What the page asks for says the same.
address=$(page_address)
python3 - "$address" <<'CHECK' || fail "the API of the page says something else"
import json
import sys
import urllib.request

def get(route):
    with urllib.request.urlopen(sys.argv[1] + "api/v1" + route, timeout=30) as answer:
        return json.load(answer)

report = get("/vehicles/boat-5/diagnosis")
assert report["causes"][0]["effects"] == ["thruster_imbalance"], report["causes"]
reasons = {boat: {reason["code"] for reason in get(f"/vehicles/{boat}")["reasons"]}
           for boat in (f"boat-{n}" for n in range(1, 7))}
assert reasons["boat-5"] == {"DRIFT"} and reasons["boat-6"] == {"CLOCK_JUMP"}, reasons
assert not any(reasons[f"boat-{n}"] for n in (1, 2, 3, 4)), reasons
CHECK

# The picture of README.md is one of these.
if $picture; then
  (cd "$modules" && timeout 180 node picture.mjs "$address" fleet.png "$(command -v chromium)") ||
    fail "the page has no picture"
fi

kill -s CONT "$demo"
wait "$demo" || fail "it exited $?"
fleet=$(sed -n '/^== The fleet/,/^== What/p' "$output")
for expected in 'boat-5 +(WARN|ERROR)' 'boat-6 +WARN'; do
  grep -qE "^$expected " <<< "$fleet" || fail "the summary has no line of $expected"
done
(($(grep -cE '^boat-[1-4] +OK ' <<< "$fleet") == 4)) || fail "a nominal boat is not OK"
sed -n '/^== What is wrong/,$p' "$output" | tr -s ' \n' ' ' | grep -q 'EXPLAINED, .* ago: Port thruster [34][0-9] % weaker' ||
  fail "the diagnosis does not name the thruster that has lost two fifths"
check_nothing_is_left
echo "the demo of the fleet shows what is wrong, and with whom"
