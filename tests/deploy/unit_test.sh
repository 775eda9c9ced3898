#!/usr/bin/env bash
# The units of the daemon expose little of the host: at most 2.0 of 10 by systemd's measure. With the drop-in for
# serial lines, which lets it see them, each is still a unit that systemd takes as it is written. Instances of the
# template have what bears their name apart, and go together.
set -euo pipefail
source=$(cd "$(dirname "$0")/../.." && pwd)
command -v systemd-analyze > /dev/null || exit 77
root=$(mktemp -d)
trap 'rm -rf "$root"' EXIT
fail() { echo "FAILED: $1" >&2; exit 1; }

units=$root/usr/lib/systemd/system
mkdir -p "$units" "$root/etc/systemd/system"
cp "$source/deploy/telltaled.service" "$TELLTALE_BUILT/deploy/telltaled@.service" "$units"
for unit in "$units"/*.service; do
  systemd-analyze security --offline=true --threshold=20 --no-pager "$unit" | tail -1
done

# verified NAME: systemd finds nothing to say of this unit with its drop-ins.
verified() {
  local said
  said=$(systemd-analyze verify --man=no "$verifying/$1" 2>&1) || fail "$1: $said"
  said=$(grep -F "$verifying" <<< "$said" || true)
  [[ -z $said ]] || fail "$said"
}
verifying=$root/verifying
mkdir "$verifying"
for unit in telltaled.service telltaled@.service; do
  sed 's|^ExecStart=telltaled|ExecStart=/usr/bin/true|' "$units/$unit" > "$verifying/$unit"
  mkdir "$verifying/$unit.d"
  cp "$source/deploy/telltaled-serial.conf" "$verifying/$unit.d/serial.conf"
done
verified telltaled.service
verified telltaled@north.service

# Two daemons on a host share neither configuration nor state, and the alone one shares none with them.
for named in --config\ /etc/telltale/%i.textproto file:///etc/telltale/%i.xml StateDirectory=telltale-%i; do
  grep -qF -- "$named" "$units/telltaled@.service" || fail "telltaled@.service does not have $named"
done
named() { grep -E 'ExecStart|CYCLONEDDS|^StateDirectory=' "$units/$1" | sort; }
common=$(comm -12 <(named telltaled.service) <(named telltaled@.service))
[[ -z $common ]] || fail "the units share $common"

# What the removal of the package runs takes the instances too.
systemctl --root="$root" --quiet enable telltaled.service telltaled@north.service telltaled@south.service 2> /dev/null
wanted=$root/etc/systemd/system/multi-user.target.wants
[[ $(find "$wanted" -name 'telltaled*' | wc -l) == 3 ]] || fail "an instance cannot be enabled"
disable=$(sed -n 's/^ *systemctl \(disable .*\)/\1/p' "$source/deploy/debian/prerm")
read -ra disable <<< "$disable"
systemctl --root="$root" --quiet "${disable[@]}" 2> /dev/null
[[ -z $(find "$root/etc/systemd" -name 'telltaled*') ]] || fail "removal leaves instances enabled"
