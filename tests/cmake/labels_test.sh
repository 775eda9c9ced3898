#!/usr/bin/env bash
# Every name in the list of campaigns of tests/CMakeLists.txt is that of a test: one that was renamed would
# run by default, for minutes. TELLTALE_BUILT names the build folder.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)

labelled=$(ctest --test-dir "$TELLTALE_BUILT" --show-only --label-regex '^campaign$')
missing=0
while read -r name; do
  pattern=${name//./[.]}
  grep -qE "^ *Test +#[0-9]+: ${pattern//\*/.*}\$" <<< "$labelled" && continue
  echo "no test is called $name" >&2
  missing=1
done < <(sed -n '/^string(JOIN ":" campaigns/,/)$/p' "$root/tests/CMakeLists.txt" | sed '1d; s/[ )]//g')
((missing == 0)) || { echo "FAILED: tests/CMakeLists.txt names campaigns that do not exist" >&2; exit 1; }
echo "every campaign is a test"
