#!/usr/bin/env bash
# Every name in the lists of tests/CMakeLists.txt that give tests a label of their own is that of a test: one that
# was renamed would run where it is to be left out. TELLTALE_BUILT names the build folder.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
missing=0

# check LIST LABEL: each name of the list is that of a test with the label.
check() {
  local labelled name pattern
  labelled=$(ctest --test-dir "$TELLTALE_BUILT" --show-only --label-regex "^$2\$")
  while read -r name; do
    pattern=${name//./[.]}
    grep -qE "^ *Test +#[0-9]+: ${pattern//\*/.*}\$" <<< "$labelled" && continue
    echo "no test with the label $2 is called $name" >&2
    missing=1
  done < <(sed -n "/^string(JOIN \":\" $1\$/,/)\$/p" "$root/tests/CMakeLists.txt" | sed '1d; s/[ )]//g')
}

check campaigns campaign
check long_tests long
((missing == 0)) || { echo "FAILED: tests/CMakeLists.txt names tests that do not exist" >&2; exit 1; }
echo "every test with a label of its own exists"
