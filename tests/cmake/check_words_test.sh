#!/usr/bin/env bash
# cmake/check-words passes on field's words and fails, with file, line and text, on retired ones.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
sandbox=$(mktemp -d)
trap 'rm -rf "$sandbox"' EXIT

fail() { echo "FAILED: $1" >&2; exit 1; }

cd "$sandbox"
git init -q .
mkdir -p docs/validation core

# rejects TEXT: a file with that line is found out.
rejects() {
  echo "$1" > core/bad.hpp
  git add -A
  local output status=0
  output=$("$root/cmake/check-words" 2>&1) || status=$?
  ((status == 1)) || fail "'$1' should be refused; exit $status, said: $output"
  grep -qF "core/bad.hpp:1:$1" <<< "$output" || fail "'$1': no file, line and text in: $output"
  rm core/bad.hpp
}

echo '/// A parametric bootstrap replicate; the simulated twin; persistence_r2 is a field of the interface.' > core/good.hpp
echo 'the twins sailed' > docs/validation/log.md
git add -A
"$root/cmake/check-words" > /dev/null || fail "words of the field, or the log of the past, are refused"

rejects '// 40 twins'
rejects '// the model runs away'
rejects '// effective windows are its worth'
rejects '// a healthy boat'
rejects '// coefficients that are told apart'
rejects 'struct Yardstick;'
rejects 'Recording RecordedAfloat();'
rejects 'int kept_twins = 0;'

"$root/cmake/check-words" core/good.hpp > /dev/null || fail "it searches beyond the paths that it is given"
echo "check-words finds retired words"
