#!/usr/bin/env bash
# The unit of the daemon exposes little of the host: at most 2.0 of 10 by systemd's measure. With the drop-in
# for serial lines, which lets it see them, it is still a unit that systemd takes as it is written.
set -euo pipefail
source=$(cd "$(dirname "$0")/../.." && pwd)
command -v systemd-analyze > /dev/null || exit 77
systemd-analyze security --offline=true --threshold=20 --no-pager "$source/deploy/telltaled.service" | tail -1

units=$(mktemp -d)
trap 'rm -rf "$units"' EXIT
mkdir "$units/telltaled.service.d"
sed 's|^ExecStart=telltaled|ExecStart=/usr/bin/true|' "$source/deploy/telltaled.service" > "$units/telltaled.service"
cp "$source/deploy/telltaled-serial.conf" "$units/telltaled.service.d/serial.conf"
said=$(systemd-analyze verify --man=no "$units/telltaled.service" 2>&1) || { echo "FAILED: $said" >&2; exit 1; }
said=$(grep -F "$units" <<< "$said" || true)
[[ -z $said ]] || { echo "FAILED: $said" >&2; exit 1; }
