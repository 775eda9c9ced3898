#!/usr/bin/env bash
# tests/blind/altered holds back what it says it does. telltale is a stand-in, the recordings are made up;
# BLIND_BUILT names the build folder whose blind_alter is the real one.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../.." && pwd)
sandbox=$(mktemp -d)
trap 'rm -rf "$sandbox"' EXIT
command -v node > /dev/null || { echo "skipped: no node"; exit 77; }

fail() { echo "FAILED: $1" >&2; cat "$sandbox/said" >&2; exit 1; }

mkdir -p "$sandbox/built/client"
cat > "$sandbox/built/client/telltale" <<'STAND_IN'
#!/usr/bin/env bash
echo "$*" >> "$SANDBOX/calls"
while (($# > 1)); do [[ $1 == --out ]] && out=$2; shift; done
echo '{"verdict": "EXPLAINED", "gap": {"before": 3.14159, "floorLimit": 2, "closure": 0.5}, "causes":
  [{"effects": ["wind"], "probability": 0.9, "parameters": [{"name": "e", "estimate": 1, "unit": "m"}]}]}' > "$out"
STAND_IN
chmod +x "$sandbox/built/client/telltale"
ln -s "$BLIND_BUILT/tests" "$sandbox/built/tests"
for run in 220 225 230 232 234; do
  log=$sandbox/data/blueboat/run$run
  mkdir -p "$log"
  awk 'BEGIN { print "time_s,latitude_deg,longitude_deg"; for (t = 0; t < 120; t += 1) print t ",63,10" }' > "$log/gnss.csv"
  awk 'BEGIN { print "time_s,heading_deg"; for (t = 0; t < 120; t += 0.5) print t ",90" }' > "$log/heading.csv"
  awk 'BEGIN { print "time_s,left_us,right_us"; for (t = 0; t < 120; t += 1) print t ",1600,1400" }' > "$log/thrusters.csv"
done
export SANDBOX=$sandbox

# run OPTION ...: runs it; what it says and its exit code are left behind.
run() {
  status=0
  : > "$sandbox/calls"
  "$root/tests/blind/altered" --built "$sandbox/built" "$@" > "$sandbox/said" 2>&1 || status=$?
}

run --data "$sandbox/data" -- --seed 7
((status == 0)) || fail "it should end in 0, not $status"
(($(grep -c '^| run2' "$sandbox/said") == 18)) || fail "it does not print a line for every alteration"
grep -qF '| run220 | none | EXPLAINED | 3.14 (2.00) | wind | 0.90 | e 1.000 m | 0.50 |' "$sandbox/said" ||
  fail "it does not print what the report says"
grep '^identify' "$sandbox/calls" | head -n 1 | grep -q -- '--log [^ ]*run220' && fail "the model knows the run held back"
grep '^diagnose' "$sandbox/calls" | head -n 9 | grep -q -- '--reference-log [^ ]*run220' &&
  fail "the run held back is its own reference"
(($(grep -c '^diagnose.*--seed 7$' "$sandbox/calls") == 18)) || fail "options after -- are lost"
grep -q '^0.000000,94' "$sandbox/built/blind/altered/run220/log-1/heading.csv" || fail "the heading is not turned"

run --data "$sandbox/nowhere"
((status == 77)) || fail "without recordings it should be skipped, not exit $status"
run --boat dalian
((status == 2)) || fail "an unknown option should exit 2, not $status"

echo "altered recordings are held against other runs"
