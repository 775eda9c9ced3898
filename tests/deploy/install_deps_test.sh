#!/usr/bin/env bash
# deploy/install-deps does nothing when all is there, and asks apt for exactly what is missing.
# dpkg-query, apt-get and sudo are stand-ins, so that the test changes nothing on this machine.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
sandbox=$(mktemp -d)
trap 'rm -rf "$sandbox"' EXIT

fail() { echo "FAILED: $1" >&2; exit 1; }

# stand_in NAME SCRIPT: puts a command of that name before the real one.
stand_in() {
  printf '#!/bin/bash\n%s\n' "$2" > "$sandbox/bin/$1"
  chmod +x "$sandbox/bin/$1"
}
mkdir "$sandbox/bin"
export MISSING="" CALLS="$sandbox/calls" PATH="$sandbox/bin:$PATH"
# shellcheck disable=SC2016  # expanded where the stand-in runs
stand_in dpkg-query '
status=0
for package in "$@"; do
  [[ $package == -* ]] && continue
  if [[ " $MISSING " == *" $package "* ]]; then status=1; else echo "installed $package"; fi
done
exit $status'
# shellcheck disable=SC2016
stand_in apt-get 'echo "apt-get $*" >> "$CALLS"'
# shellcheck disable=SC2016
stand_in sudo 'exec "$@"'

# run ARGUMENT...: runs install-deps with a clean record of calls; output and status are left behind.
run() {
  : > "$CALLS"
  status=0
  output=$("$root/deploy/install-deps" "$@" 2>&1) || status=$?
}

run
((status == 0)) || fail "all there, yet exit $status: $output"
[[ $output == *"packages are there"* ]] || fail "all there, but it does not say so: $output"
[[ ! -s $CALLS ]] || fail "all there, yet it called $(cat "$CALLS")"

MISSING="libeigen3-dev libspdlog-dev" run
((status == 0)) || fail "two missing: exit $status: $output"
[[ $(sed -n 1p "$CALLS") == *" update" ]] || fail "the package lists were not updated first"
[[ $(sed -n 2p "$CALLS") == *"install --yes --no-install-recommends libeigen3-dev libspdlog-dev" ]] ||
  fail "two missing, but it called $(cat "$CALLS")"

MISSING="clang-tidy-16" run
[[ ! -s $CALLS ]] || fail "a CI package was installed without --ci"
MISSING="clang-tidy-16" run --ci
grep -q 'install .* clang-tidy-16$' "$CALLS" || fail "--ci did not install clang-tidy-16"

MISSING="chromium" run
[[ ! -s $CALLS ]] || fail "the browser was installed without --tests"
MISSING="chromium" run --tests
grep -qE 'install .* chromium( |$)' "$CALLS" || fail "--tests did not install the browser"

run --no-such-option
((status == 2)) || fail "an unknown option should exit 2, not $status"

echo "install-deps does what is needed and nothing else"
