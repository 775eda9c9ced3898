#!/usr/bin/env bash
# An installation serves a program outside the tree: examples/subscribe finds the package, builds and runs,
# and the installed commands say their version. TELLTALE_BUILT names the build folder to install.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
sandbox=$(mktemp -d)
trap 'rm -rf "$sandbox"' EXIT

fail() { echo "FAILED: $1" >&2; [[ ! -f $sandbox/output ]] || tail -n 40 "$sandbox/output" >&2; exit 1; }

cmake --install "$TELLTALE_BUILT" --prefix "$sandbox/prefix" &> "$sandbox/output" || fail "it does not install"

version=$(sed -nE 's/^project\(telltale VERSION ([0-9.]+).*/\1/p' "$root/CMakeLists.txt")
for command in telltale telltaled; do
  said=$("$sandbox/prefix/bin/$command" --version 2>&1) || fail "$command --version fails: $said"
  [[ $said == *"$version"* ]] || fail "$command --version says '$said', not $version"
done

if grep -q '^TELLTALE_PYTHON:BOOL=ON' "$TELLTALE_BUILT/CMakeCache.txt"; then
  said=$(PYTHONPATH=$(echo "$sandbox"/prefix/lib/python3*/dist-packages) /usr/bin/python3 -c \
    'import telltale; print(telltale.__file__, telltale.__version__)' 2>&1) || fail "import telltale fails: $said"
  [[ $said == "$sandbox"/*" $version" ]] || fail "import telltale finds '$said', not $version"
fi

# Every include line of an installed header that names this project finds an installed header.
while IFS= read -r header; do
  [[ -f $sandbox/prefix/include/$header ]] || fail "$header is included, but not installed"
done < <(grep -rhoE '^#include "telltale/[^"]+' "$sandbox/prefix/include" | cut -d'"' -f2 | sort -u)

cp -r "$root/examples/subscribe" "$sandbox/subscribe"
cmake -S "$sandbox/subscribe" -B "$sandbox/build" -G Ninja -DCMAKE_PREFIX_PATH="$sandbox/prefix" \
  -DCMAKE_BUILD_TYPE=Debug &> "$sandbox/output" || fail "find_package(telltale) fails"
cmake --build "$sandbox/build" &> "$sandbox/output" || fail "examples/subscribe does not build"
"$sandbox/build/subscribe" --help | grep -q '^Usage: subscribe' || fail "subscribe --help says no usage"

# Nobody publishes in this domain: it waits its second and ends well.
export TELLTALE_DDS_TAG=install-$$ CYCLONEDDS_URI=file://$root/deploy/cyclonedds/loopback.xml
timeout 20 "$sandbox/build/subscribe" 78 1 &> "$sandbox/output" || fail "subscribe does not run"
[[ ! -s $sandbox/output ]] || fail "subscribe prints models that nobody published"

sed -i 's/telltale 0[.]2/telltale 9.0/' "$sandbox/subscribe/CMakeLists.txt"
if cmake -S "$sandbox/subscribe" -B "$sandbox/newer" -G Ninja -DCMAKE_PREFIX_PATH="$sandbox/prefix" &> "$sandbox/output"; then
  fail "a package of version $version passes for 9.0"
fi

echo "the installed package serves a program outside the tree"
