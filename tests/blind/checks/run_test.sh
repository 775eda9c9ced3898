#!/usr/bin/env bash
# tests/blind/run goes from an empty folder to a score, keeps what is there, and goes on after a failure.
# telltale is a stand-in; BLIND_BUILT names the build folder whose other programs are the real ones.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../.." && pwd)
sandbox=$(mktemp -d)
trap 'rm -rf "$sandbox"' EXIT

fail() { echo "FAILED: $1" >&2; cat "$sandbox/said" >&2; exit 1; }

# Writes a model or a report; case 002 is refused, case 003 fails until $sandbox/mended is there.
stand_in() {
  mkdir -p "$sandbox/built/client"
  cat > "$sandbox/built/client/telltale" <<'STAND_IN'
#!/usr/bin/env bash
echo "$*" >> "$SANDBOX/calls"
while (($# > 1)); do [[ $1 == --out ]] && out=$2; shift; done
case "$out" in
  */002.part) exit 3 ;;
  */003.part) [[ -e $SANDBOX/mended ]] || exit 1 ;;
esac
echo '{"verdict": "NO_MATERIAL_GAP"}' > "$out"
STAND_IN
  chmod +x "$sandbox/built/client/telltale"
  ln -s "$BLIND_BUILT/tests" "$sandbox/built/tests"
}

# run OPTION ...: runs it; what it says and its exit code are left behind.
run() {
  status=0
  "$root/tests/blind/run" --built "$sandbox/built" --duration 10 "$@" > "$sandbox/said" 2>&1 || status=$?
}

export SANDBOX=$sandbox
stand_in
set_folder=$sandbox/built/blind/development
run --set development --cases 4 --jobs 2
((status == 1)) || fail "a case without a report should end in 1, not $status"
grep -q 'diagnose on case 003 exited 1' "$sandbox/said" || fail "it does not say which case failed"
[[ -s $set_folder/reports/004.json ]] || fail "the cases after the failure were not run"
grep -q INSUFFICIENT_DATA "$set_folder/reports/002.json" || fail "a refusal is no report"
(($(grep -c '^identify' "$sandbox/calls") == 4)) || fail "not every hull was identified"
grep -q '^diagnose .*--reference-log [^ ]*/reference-4 ' "$sandbox/calls" || fail "no reference logs"

: > "$sandbox/calls"
touch "$sandbox/mended"
run --set development --cases 4 --jobs 2 -- --seed 7
((status == 0)) || fail "the second run should end in 0, not $status"
(($(wc -l < "$sandbox/calls") == 1)) || fail "what was there was done again"
grep -q -- '--seed 7$' "$sandbox/calls" || fail "options after -- do not reach telltale diagnose"
grep -q '^| 4 cases | reports |' "$sandbox/said" || fail "it does not score"

# Models of another structure stand beside the others.
: > "$sandbox/calls"
run --set development --cases 4 --structure fossen
((status == 0)) || fail "another structure should end in 0, not $status"
(($(grep -c '^identify .*--structure=fossen ' "$sandbox/calls") == 4)) || fail "models of another structure were not made"
grep -q '^diagnose .*/model-fossen.json ' "$sandbox/calls" || fail "the other models were not taken"
[[ -s $set_folder/reports-fossen/004.json ]] || fail "no reports by the other models"
run --set development --cases 4 --structure cubic
((status == 2)) || fail "an unknown structure should end in 2, not $status"

# A set simulated once gets its second recordings, but never those of another set.
run --set development --cases 4 --realised
((status == 0)) || fail "simulating again should end in 0, not $status"
[[ -s $set_folder/cases/004/again/gnss.csv ]] || fail "no second recording"
rm -r "$set_folder"/cases/*/again
run --set development --cases 4 --realised --seed 2
((status == 1)) || fail "second recordings of another seed should end in 1, not $status"
[[ ! -e $set_folder/cases/004/again ]] || fail "second recordings of another seed were taken"

# Each single effect is left out of its own case, and only once all is reported.
: > "$sandbox/calls"
left=$sandbox/left
run --set development --out "$left" --cases 8 --every 2 --leave-one-out
((status == 0)) || fail "leaving effects out should end in 0, not $status"
[[ -s $left/reports/003.json && ! -e $left/reports/002.json ]] || fail "--every 2 takes others"
"$BLIND_BUILT/tests/blind/blind_score" --set-dir "$left" --reports "$left/reports" --partial \
  --single-effects > "$sandbox/singles"
[[ -s $sandbox/singles ]] || fail "there is no single effect among the cases"
while read -r case effect; do
  grep -q "cases/$case/log .*--without $effect$" "$sandbox/calls" || fail "$effect was not left out of $case"
  [[ -s $left/reports/left-out/$case.json ]] || fail "no report without the effect of $case"
done < "$sandbox/singles"
(($(grep -c -- '--without' "$sandbox/calls") == $(wc -l < "$sandbox/singles"))) || fail "too much was left out"
grep '^diagnose' "$sandbox/calls" | sed -n '1,4p' | grep -q -- '--without' &&
  fail "an effect was left out before all was reported"

run --set both
((status == 2)) || fail "an unknown set should exit 2, not $status"
run --set development --jobs none
((status == 2)) || fail "bad jobs should exit 2, not $status"
run --set development --every 0
((status == 2)) || fail "every no-th case should exit 2, not $status"

echo "the blind run goes on where it stopped"
