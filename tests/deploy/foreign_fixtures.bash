#!/usr/bin/env bash
# For the tests of foreign recordings, which source this: the start of a telemetry log in a folder of its own, and
# what the writers from npm make of it. TELLTALE_BUILT names the build folder, where the writers are kept. Skipped
# where they cannot be installed; in CI that is a failure.
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
# shellcheck disable=SC2034  # for who sources this
telltale=$TELLTALE_BUILT/client/telltale
writers=$TELLTALE_BUILT/foreign_writers
foreign=$root/tests/client/recording/foreign
"$root/tests/deploy/from_npm" "$foreign" "$writers" lz4

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# make_fixtures SECONDS: the log's start in $work/log, and in $work/made what is made of it.
make_fixtures() {
  mkdir "$work/log"
  for channel in gnss heading thrusters; do
    awk -F, -v last="$1" 'NR == 1 || $1 <= last' "$root/deploy/sample/$channel.csv" > "$work/log/$channel.csv"
  done
  node "$writers/write_fixtures.mjs" "$work/log" "$work/made"
}
