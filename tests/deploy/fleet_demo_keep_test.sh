#!/usr/bin/env bash
# deploy/demo --fleet --keep goes on after its summary: the boats move in real time, the page shows them live, and
# Ctrl-C ends all of it.
set -euo pipefail
# shellcheck source=tests/deploy/running_demo.bash
source "$(dirname "${BASH_SOURCE[0]}")/running_demo.bash"

begin_demo --fleet --keep
await_line 'The boats go on, at last for ten minutes in real time. Ctrl-C ends the demo.'

# In real time a boat sends five fixes a second; replayed before, ten times as many.
python3 - "$(page_address)" <<'CHECK' || fail "the boats do not go on in real time"
import json
import sys
import time
import urllib.request

def get(route):
    with urllib.request.urlopen(sys.argv[1] + "api/v1" + route, timeout=30) as answer:
        return json.load(answer)

end = time.monotonic() + 240
waited_for = {f"boat-{n}" for n in range(1, 7)}
while waited_for:
    assert time.monotonic() < end, waited_for
    for boat in sorted(waited_for):
        quality = get(f"/vehicles/{boat}")
        if quality["verdict"] != "STALE" and 3 < quality["ratesHz"]["gnss"] < 8:
            waited_for.discard(boat)
    time.sleep(0.2)
CHECK
kill -0 "$demo" || fail "it has ended"

kill -s INT -- "-$demo"
status=0
wait "$demo" || status=$?
((status == 130)) || fail "Ctrl-C ends it with $status"
check_nothing_is_left
echo "the demo of the fleet goes on until Ctrl-C"
