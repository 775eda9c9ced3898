#!/usr/bin/env bash
# Walks the page of real daemons in Chromium: tests/web/{page,large_fleet,fleet_map}_test.mjs.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
built=${TELLTALE_BUILT:-$root/build/release}
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome || true)
missing=
[[ -n $browser ]] || missing=chromium
command -v npm > /dev/null || missing=npm
if [[ -n $missing ]]; then
  [[ ${CI-} != true ]] || { echo "page_test: no $missing" >&2; exit 1; }
  echo "page_test: skipped, no $missing (deploy/install-deps --tests)"
  exit 77
fi
if grep -qx 'TELLTALE_PAGE:BOOL=OFF' "$built/CMakeCache.txt"; then
  echo "page_test: skipped, built without the page"
  exit 77
fi
modules=$built/tests/page
mkdir -p "$modules/pictures"
cp -p "$root"/tests/web/{package.json,package-lock.json,page_walk.mjs,page_test.mjs,large_fleet_test.mjs,fleet_map_test.mjs} "$modules"
if [[ ! -f $modules/node_modules/.package-lock.json || $modules/package-lock.json -nt $modules/node_modules/.package-lock.json ]]; then
  (cd "$modules" && npm ci --no-audit --no-fund --loglevel=error)
fi
exec python3 "$root/tests/web/page_test.py" "$modules" "$modules/pictures" "$browser"
