#!/usr/bin/env bash
# cmake/check-docs passes on this project with the commands of TELLTALE_BUILT, and fails, with file, line and
# fault, on each kind of fault. In the sandbox the commands are stand-ins.
# shellcheck disable=SC2016  # pages quote code in backticks, which nothing is to expand
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
check=$root/cmake/check-docs
sandbox=$(mktemp -d)
trap 'rm -rf "$sandbox"' EXIT

fail() { echo "FAILED: $1" >&2; exit 1; }

# A small tree without faults, and commands of two options.
build_tree() {
  rm -rf "${sandbox:?}"/*
  mkdir -p "$sandbox"/{built/client,built/service,docs/reference,docs/validation,core}
  cat > "$sandbox/built/client/telltale" <<'COMMAND'
#!/bin/sh
case "$1" in
  watch) printf 'Usage: telltale watch [OPTIONS]\n  --all   every vehicle\n' ;;
  *) printf 'Usage: telltale SUBCOMMAND\n  --version\n\nSubcommands:\n  watch   Follows models\n' ;;
esac
COMMAND
  printf '#!/bin/sh\necho "  --config FILE"\n' > "$sandbox/built/service/telltaled"
  chmod +x "$sandbox"/built/*/*
  printf '// docs/model.md (3), docs/model.md.\nint BodyTerm();\n' > "$sandbox/core/body.hpp"
  printf '# Model\n\n(3) a = b\n' > "$sandbox/docs/model.md"
  cat > "$sandbox/docs/index.md" <<'PAGE'
# Index

A [page](model.md#model), `core/body.hpp`, `BodyTerm`, `--all` and `telltale watch --all`.

## Two words, and `code`
[here](#two-words-and-code)

```
sudo telltaled --config a.textproto && build/release/client/telltale watch \
  --all    # comment --wrong
telltale --version
```
PAGE
  "$check" --update --built "$sandbox/built" "$sandbox" > "$sandbox/said" || fail "a tree in order was refused: $(cat "$sandbox/said")"
}

# rejects LINE FAULT [FILE]: that line at the end of the page is found out.
rejects() {
  build_tree
  local file=${3-docs/index.md} output status=0 line
  printf '%b\n' "$1" >> "$sandbox/$file"
  line=$(wc -l < "$sandbox/$file")
  output=$("$check" --built "$sandbox/built" "$sandbox" 2>&1) || status=$?
  ((status == 1)) || fail "'$1' should be refused; exit $status, said: $output"
  grep -qE "^$file:($line|$((line - 1))|$((line - 2))): .*$2" <<< "$output" || fail "'$1': no file, line and '$2' in: $output"
}

build_tree
rejects '[gone](gone.md)' 'gone.md leads nowhere'
rejects '![gone](gone.svg)' 'gone.svg leads nowhere'
rejects '[gone](model.md#gone)' 'there is no such heading'
rejects '[gone](#gone)' 'there is no such heading'
rejects '`core/gone.hpp`' 'there is no core/gone.hpp'
rejects '`GoneTerm`' 'the code has no GoneTerm'
rejects '`telltale watch --gone`' 'telltale watch has no option --gone'
rejects '`telltale gone`' "telltale has no subcommand 'gone'"
rejects '`--gone`' 'no --help knows --gone'
rejects '```\ntelltaled --gone x\n```' 'telltaled has no option --gone'
rejects '```sh\nsudo telltale watch --all \\\\\n  --gone\n```' 'telltale watch has no option --gone'
rejects '// docs/gone.md' 'there is no docs/gone.md' core/body.hpp
rejects '// docs/model.md (4)' 'has no equation \(4\)' core/body.hpp

build_tree
echo '`telltale gone` and `GoneTerm`' > "$sandbox/docs/validation/log.md"
"$check" --built "$sandbox/built" "$sandbox" > /dev/null || fail "the log may name what was"
echo more >> "$sandbox/docs/reference/commands.md"
if "$check" --built "$sandbox/built" "$sandbox" > /dev/null 2>&1; then fail "a stale list of commands passed"; fi
if "$check" --built "$sandbox/nowhere" "$sandbox" > /dev/null 2>&1; then fail "it passed without commands"; fi

"$check" --built "$TELLTALE_BUILT" "$root" || fail "this project's pages have faults"
echo "check-docs finds every kind of fault"
