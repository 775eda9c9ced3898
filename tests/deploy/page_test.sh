#!/usr/bin/env bash
# Walks the page of real daemons in Chromium: tests/web/{page,large_fleet,fleet_map}_test.mjs.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
built=${TELLTALE_BUILT:-$root/build/release}
if grep -qx 'TELLTALE_PAGE:BOOL=OFF' "$built/CMakeCache.txt"; then
  echo "page_test: skipped, built without the page"
  exit 77
fi
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome || true)
modules=$built/tests/page
"$root/tests/deploy/from_npm" "$root/tests/web" "$modules" "${browser:-chromium}"
mkdir -p "$modules/pictures"
exec python3 "$root/tests/web/page_test.py" "$modules" "$modules/pictures" "$browser"
