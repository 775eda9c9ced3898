#!/usr/bin/env bash
# The manifests of deploy/kubernetes keep to the schema of Kubernetes and to each other, and the daemon takes their
# configuration and options. No cluster runs them.
set -euo pipefail
source=$(cd "$(dirname "$0")/../.." && pwd)
telltaled=$TELLTALE_BUILT/service/telltaled
/usr/bin/python3 -c 'import kubernetes, yaml' 2> /dev/null || { echo "skipped: needs python3-kubernetes"; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
fail() { echo "FAILED: $1" >&2; cat "$folder"/* >&2 2> /dev/null; exit 1; }

manifests=$source/deploy/kubernetes
check=("$source/tests/deploy/kubernetes_manifests.py")
against=("$source/docs/reference/openapi.json" "$source/docs/guides/kubernetes.md")
/usr/bin/python3 "${check[@]}" "$manifests" "${against[@]}"

# Faults that the check has to find.
finds() {  # FAULT SED-SCRIPT
  mkdir -p "$folder/wrong"
  cp "$manifests"/*.yaml "$folder/wrong"
  sed -i "$2" "$folder/wrong"/*.yaml
  ! /usr/bin/python3 "${check[@]}" "$folder/wrong" "${against[@]}" > "$folder/said" || fail "the check misses: $1"
  grep -qF "$1" "$folder/said" || fail "the check finds otherwise than: $1"
}
finds "livenesProbe is not of the schema" 's/livenessProbe/livenesProbe/'
finds "periodSeconds is '5'" 's/periodSeconds: 5/periodSeconds: "5"/'
finds "which is no volume" 's/name: state, mountPath/name: stat, mountPath/'
finds "which is no route" 's|path: /api/v1/alive|path: /healthz|'
finds "must not be" 's/^  selector:/  selectors:/'

# As a ConfigMap is mounted: each file a link to a link.
mkdir -p "$folder/vehicles/..now" "$folder/state"
cp "$source/deploy/sample/yellowfish.textproto" "$folder/vehicles/..now"
ln -s ..now "$folder/vehicles/..data"
ln -s ..data/yellowfish.textproto "$folder/vehicles/yellowfish.textproto"
sed "s|/etc/telltale/vehicles|$folder/vehicles|" "$manifests/telltaled.textproto" > "$folder/telltaled.textproto"
echo "state_directory: \"$folder/state\"" >> "$folder/telltaled.textproto"
# No server is there: the daemon has read its configuration where it says so, and exits with 1.
code=0
PGHOST=127.0.0.1 PGPORT=1 PGUSER=telltale timeout 60 "$telltaled" --config "$folder/telltaled.textproto" &> "$folder/log" || code=$?
[[ $code == 1 ]] || fail "telltaled exits with $code"
grep -qi "connect" "$folder/log" || fail "telltaled ends for another reason"

help=$("$telltaled" --help)
mapfile -t options < <(grep -ohE 'command: .*' "$manifests"/*.yaml | grep -oE -- '--[a-z-]+' | sort -u)
for option in "${options[@]}"; do
  [[ $help == *"$option"* ]] || fail "telltaled has no $option"
done
