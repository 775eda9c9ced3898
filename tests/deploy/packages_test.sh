#!/usr/bin/env bash
# The Debian packages of the tree hold what they should, lintian finds no error in them, and what they unpack
# runs. TELLTALE_BUILT names the build folder to pack.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
sandbox=$(mktemp -d)
trap 'rm -rf "$sandbox"' EXIT

fail() { echo "FAILED: $1" >&2; [[ ! -f $sandbox/output ]] || tail -n 40 "$sandbox/output" >&2; exit 1; }

"$root/deploy/packages" --built "$TELLTALE_BUILT" --out "$sandbox/packages" &> "$sandbox/output" ||
  fail "deploy/packages fails"

# contents PACKAGE: the paths that it unpacks, folders with a slash at their end.
contents() { dpkg --contents "$sandbox/packages/$1"_*.deb | awk '{ print substr($6, 2) }'; }

# holds PACKAGE PATH: the package unpacks that path.
holds() { [[ $'\n'$(contents "$1")$'\n' == *$'\n'"$2"$'\n'* ]] || fail "$1 does not hold $2"; }

holds telltale /usr/bin/telltale
holds telltaled /usr/bin/telltaled
holds telltaled /usr/lib/systemd/system/telltaled.service
holds telltaled /usr/lib/systemd/system/telltaled@.service
holds telltaled /etc/telltale/telltaled.textproto
holds libtelltale-dev /usr/include/telltale/core/identification/identify.hpp
holds libtelltale-dev /usr/lib/cmake/telltale/telltaleConfig.cmake
packages=(telltale telltaled libtelltale-dev)
if grep -q '^TELLTALE_PYTHON:BOOL=ON' "$TELLTALE_BUILT/CMakeCache.txt"; then
  holds python3-telltale /usr/lib/python3/dist-packages/telltale/__init__.py
  packages+=(python3-telltale)
fi
[[ $(find "$sandbox/packages" -name '*.deb' | wc -l) == "${#packages[@]}" ]] || fail "there are other packages than ${packages[*]}"

lintian --fail-on error --tag-display-limit 0 "$sandbox"/packages/*.deb &> "$sandbox/output" || fail "lintian finds errors"

for package in "${packages[@]}"; do
  holds "$package" "/usr/share/doc/$package/copyright"
  dpkg --extract "$sandbox/packages/$package"_*.deb "$sandbox/tree"
done
version=$(sed -nE 's/^project\(telltale VERSION ([0-9.]+).*/\1/p' "$root/CMakeLists.txt")
for command in telltale telltaled; do
  said=$("$sandbox/tree/usr/bin/$command" --version 2>&1) || fail "$command --version fails: $said"
  [[ $said == *"$version"* ]] || fail "$command --version says '$said', not $version"
done
if [[ -d $sandbox/tree/usr/lib/python3 ]]; then
  said=$(PYTHONPATH=$sandbox/tree/usr/lib/python3/dist-packages /usr/bin/python3 -c \
    'import telltale; print(telltale.__version__)' 2>&1) || fail "import telltale fails: $said"
  [[ $said == "$version" ]] || fail "import telltale says '$said', not $version"
fi

# Two packages that unpack one file cannot be installed together.
twice=$(for package in "${packages[@]}"; do contents "$package"; done | grep -v '/$' | sort | uniq -d)
[[ -z $twice ]] || fail "several packages hold $twice"

echo "${packages[*]} unpack and run"
