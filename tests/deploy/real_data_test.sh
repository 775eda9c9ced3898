#!/usr/bin/env bash
# Every real recording ends in a model or a reasoned refusal, and every model can be scored on another
# recording of its boat. TELLTALE_BUILT names the build folder, TELLTALE_SHARED_DATA the recordings.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
readonly skipped=77
data=${TELLTALE_SHARED_DATA-$root/../shared/data}
if [[ ! -d $data ]]; then
  [[ ${TELLTALE_REQUIRE_SHARED_DATA-} == 1 ]] && { echo "FAILED: no recordings at $data" >&2; exit 1; }
  echo "skipped: no recordings at $data"
  exit $skipped
fi
models=$(mktemp -d)
trap 'rm -rf "$models"' EXIT
telltale=$TELLTALE_BUILT/client/telltale

fail() { echo "FAILED: $1" >&2; cat "$models/said" >&2; exit 1; }

for log in "$data"/*/*/; do
  boat=$(basename "$(dirname "$log")")
  name=$boat/$(basename "$log")
  vehicle=$root/docs/vehicles/$boat.textproto
  status=0
  "$telltale" identify --log "$log" --vehicle "$vehicle" --out "$models/model.json" \
    > "$models/table" 2> "$models/said" || status=$?
  if ((status == 3)); then
    [[ -s $models/said ]] || fail "$name is refused without a reason"
    echo "$name: refused"
    continue
  fi
  ((status == 0)) || fail "identify on $name exited $status"
  said=$(tr -s '\n ' ' ' < "$models/table")
  # Simulated replicates of so short a recording diverge; those of a stronger prior have to serve it.
  [[ $said != *"fewer than half of the parametric bootstrap replicates"* ]] ||
    fail "the bounds of $name are not calibrated"
  for other in "$data/$boat"/*/; do
    status=0
    "$telltale" validate --log "$other" --vehicle "$vehicle" --model "$models/model.json" \
      > "$models/scores" 2> "$models/said" || status=$?
    ((status == 0 || status == 3)) || fail "validate of $name on $other exited $status"
    if ((status == 0)); then
      grep -q 'of constant velocity' "$models/scores" ||
        fail "no constant velocity beside the score of $name"
    fi
    # The values for simulation stay bounded where the model was made, or the model warns that they do not.
    if [[ $other -ef $log ]]; then
      if grep -q '^5 s: .*diverges' "$models/scores"; then
        [[ $said == *"Simulation: not advised"* ]] ||
          fail "$name diverges over its own recording without a warning"
        echo "$name: warned of"
      elif [[ $said == *"Simulation: possible with the regularised values"* ]]; then
        echo "$name: simulated with regularised values"
      fi
    fi
  done
  echo "$name: identified"
done
