#!/usr/bin/env bash
# For the tests of deploy/demo, which source this: a demo that runs, and what it leaves behind.
# TELLTALE_BUILT names the build folder.
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
built=${TELLTALE_BUILT:-$root/build/release}
sandbox=$(mktemp -d)
demo=
output=$sandbox/output
stop_demo() {
  if [[ -n $demo ]] && kill -s TERM "$demo" 2> /dev/null; then
    kill -s CONT "$demo"
    wait "$demo" || true
  fi
}
trap 'stop_demo; rm -rf "$sandbox"' EXIT
mkdir "$sandbox/tmp"
export TMPDIR=$sandbox/tmp
unset TELLTALE_DDS_TAG

fail() { echo "FAILED: $1" >&2; cat "$output" >&2; exit 1; }

# begin_demo OPTION...: in the background, with job control, so that it takes a Ctrl-C as from a terminal.
begin_demo() {
  : > "$output"
  set -m
  "$root/deploy/demo" --built "$built" "$@" &> "$output" &
  demo=$!
  set +m
}

# await_line TEXT: until the demo has printed a line that has it.
await_line() {
  until grep -qF -- "$1" "$output"; do
    kill -0 "$demo" 2> /dev/null || fail "it ended before it printed '$1'"
    sleep 0.05
  done
}

page_address() { sed -n 's/^Open //p' "$output"; }

# left_over: processes that carry the discovery tag of the demo.
left_over() {
  grep -lzx "TELLTALE_DDS_TAG=demo-$demo" /proc/[0-9]*/environ 2> /dev/null || true
}

check_nothing_is_left() {
  [[ -z $(left_over) ]] || fail "still running: $(left_over)"
  [[ -z $(ls -A "$TMPDIR") ]] || fail "left behind: $(ls -A "$TMPDIR")"
}
