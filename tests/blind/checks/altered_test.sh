#!/usr/bin/env bash
# bench/altered_real_runs.py holds back what it says it does. telltale is a stand-in, the recordings are made
# up; BLIND_BUILT names the build folder whose blind_alter is the real one.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../.." && pwd)
sandbox=$(mktemp -d)
trap 'rm -rf "$sandbox"' EXIT
command -v python3 > /dev/null || { echo "skipped: no python3"; exit 77; }

fail() { echo "FAILED: $1" >&2; cat "$sandbox/said" >&2; exit 1; }

mkdir -p "$sandbox/built/client"
cat > "$sandbox/built/client/telltale" <<'STAND_IN'
#!/usr/bin/env bash
echo "$*" >> "$SANDBOX/calls"
command=$1
while (($# > 1)); do
  case $1 in
    --out) out=$2 ;;
    --model) grep -q recordings "$2" && exit 3 ;;  # as telltale refuses references that made the model
    --log) cat "$2/heading.csv" >> "$SANDBOX/headings" ;;
  esac
  shift
done
if [[ $command == identify ]]; then
  echo '{"provenance": {"recordings": [{"name": "run225"}]}, "parameters": [{"symbol": "Tf1", "estimate": 1},
    {"symbol": "Tf2", "estimate": 2}, {"symbol": "Tr1", "estimate": 1}, {"symbol": "Tr2", "estimate": 2},
    {"symbol": "df", "estimate": 0.02}, {"symbol": "dr", "estimate": 0.03}]}' > "$out"
  exit
fi
influence='{"verdict": "EXPLAINED", "effects": ["heading_bias"]}'
echo '{"verdict": "EXPLAINED", "gap": {"before": 3.14159, "floorLimit": 2},
  "nominalDaysLimit": 2.5,
  "referenceInfluence": ['"$influence, $influence, $influence, $influence"'],
  "effects": [{"effect": "heading_bias", "detectableSizes": [{"name": "bias", "size": 0.2, "unit": "rad"}]}], "causes": [{"effects": ["heading_bias"],
  "probability": 0.9, "parameters": [{"name": "bias", "estimate": 0.06, "unit": "rad", "effect": "heading_bias"}]}]}' > "$out"
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
  python3 "$root/bench/altered_real_runs.py" --built "$sandbox/built" "$@" > "$sandbox/said" 2>&1 || status=$?
}

run --data "$sandbox/data" --held run220
((status == 0)) || fail "it should end in 0, not $status"
(($(grep -c '^| run220 |.*EXPLAINED | 3.14 (2.00)' "$sandbox/said") == 17)) || fail "it does not print a line for every alteration"
grep -qF '| run220 | heading +4 degrees | EXPLAINED | 3.14 (2.00) | heading_bias | 0.90 | 0.06 (0.07) rad | 0.20 rad |' "$sandbox/said" ||
  fail "it does not print what the report says"
grep -qF '| none | 4 | 0 | 4 | 0 | 4 |' "$sandbox/said" || fail "a cause named without an alteration is a wrong one"
grep -qF '| heading +4 degrees | 4 | 4 | 0 | 4 | 4 |' "$sandbox/said" || fail "the true cause counts as another"
grep -qF '| run220 | 17 of 17 | 4 EXPLAINED |' "$sandbox/said" || fail "verdicts that agree do not count so"
grep '^identify' "$sandbox/calls" | grep -q -- '--log [^ ]*run220' && fail "the model knows the run held back"
grep '^diagnose' "$sandbox/calls" | grep -q -- '--reference-log [^ ]*run220' &&
  fail "the run held back is its own reference"
grep -qF '| heading_bias | 0.2 rad |' "$sandbox/said" || fail "it does not list the size that shows"
for sign in + -; do
  grep -qF "| run220 | heading_bias bias ${sign}0.2 rad | EXPLAINED | 3.14 (2.50) | heading_bias |" "$sandbox/said" ||
    fail "it does not alter the run by the size that shows, to either side"
done
grep -qF '| run220 | – | EXPLAINED, 3.14 (2.50) | EXPLAINED, 3.14 (2.50) | EXPLAINED, 3.14 (2.50) | EXPLAINED, 3.14 (2.50) |' \
  "$sandbox/said" || fail "it does not say what three references make of the unaltered run"
# 17 alterations, the size that shows to either side, and four choices of three references.
(($(grep -c '^diagnose' "$sandbox/calls") == 23)) || fail "it does not diagnose everything once"
(($(grep '^diagnose' "$sandbox/calls" | grep -o -- '--reference-log' | wc -l) == 19 * 4 + 4 * 3)) ||
  fail "it does not leave out one reference of four"
grep -q '^0.000000,94' "$sandbox/headings" || fail "the heading is not turned"

run --data "$sandbox/nowhere"
((status == 77)) || fail "without recordings it should be skipped, not exit $status"
run --data "$sandbox/data" --held run999
((status == 2)) || fail "an unknown run should exit 2, not $status"
grep -q 'run220, run225' "$sandbox/said" || fail "it does not say which runs there are"

echo "altered recordings are held against other runs"
