#!/usr/bin/env bash
# The Debian packages install, run, upgrade with their data and go again, in a Debian of their own. On demand,
# with TELLTALE_DEBOOTSTRAP=1: it needs root and a mirror of Debian, and takes minutes.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
[[ ${TELLTALE_DEBOOTSTRAP-} == 1 ]] || { echo "skipped: TELLTALE_DEBOOTSTRAP=1 asks for it"; exit 77; }
[[ $EUID == 0 ]] || { echo "skipped: needs root"; exit 77; }

sandbox=$(mktemp -d)
tree=$sandbox/debian
daemon=''
stop() { [[ -z $daemon ]] || kill "$daemon" 2> /dev/null || true; }
clean() {
  stop
  ! mountpoint -q "$tree/proc" || umount "$tree/proc"
  rm -rf "$sandbox"
}
trap clean EXIT
fail() { echo "FAILED: $1" >&2; tail -n 40 "$sandbox/output" >&2; exit 1; }
# run WHAT COMMAND...: its output goes to a file, which is shown where it fails.
run() { "${@:2}" &> "$sandbox/output" || fail "$1"; }
inside() { chroot "$tree" env DEBIAN_FRONTEND=noninteractive LC_ALL=C "$@"; }

pack() {
  run "packing release $1" "$root/deploy/packages" --built "$TELLTALE_BUILT" --out "$sandbox/packages-$1" --release "$1"
  mkdir -p "$tree/root/release-$1"
  cp "$sandbox/packages-$1"/*.deb "$tree/root/release-$1"
}
# packed RELEASE NAME...: the files of these packages, as the tree sees them.
packed() { (cd "$tree" && for name in "${@:2}"; do printf '/%s\n' "root/release-$1/${name}"_*.deb; done); }
# start: telltaled, as its unit starts it.
start() {
  chroot "$tree" env CYCLONEDDS_URI=file:///etc/telltale/cyclonedds.xml \
    telltaled --config /etc/telltale/telltaled.textproto &> "$sandbox/daemon" &
  daemon=$!
  grep -q -m 1 "serving 2 vehicles" < <(timeout 60 tail -n +1 -f "$sandbox/daemon" --pid "$daemon") ||
    { cp "$sandbox/daemon" "$sandbox/output"; fail "telltaled does not serve"; }
}
finish() {
  kill -TERM "$daemon"
  wait "$daemon" || { cp "$sandbox/daemon" "$sandbox/output"; fail "telltaled does not end in order"; }
  daemon=''
}
telltale() { inside env CYCLONEDDS_URI=file:///etc/telltale/cyclonedds.xml telltale "$@"; }

echo "== A Debian of its own"
run debootstrap debootstrap --variant=minbase bookworm "$tree" "${TELLTALE_MIRROR:-http://deb.debian.org/debian}"
mount -t proc proc "$tree/proc"
pack 1

echo "== The packages install and run"
mapfile -t first < <(packed 1 telltale telltaled python3-telltale)
run "installing" inside apt-get install -y --no-install-recommends "${first[@]}"
run "resolving what libtelltale-dev needs" inside apt-get install --simulate "$(packed 1 libtelltale-dev)"
run "import telltale" inside python3 -c 'import telltale; print(telltale.__version__)'
cp -r "$root/deploy/sample" "$tree/root/sample"
echo 'vehicle_files: "/root/sample/yellowfish.textproto"' >> "$tree/etc/telltale/telltaled.textproto"
mkdir -p "$tree/var/lib/telltale"  # which the unit makes
start
run replay telltale replay --log /root/sample --vehicle-id yellowfish --speed 100
run identify telltale identify --vehicle-id yellowfish --estimator one-step
finish

echo "== An upgrade keeps configuration and data"
pack 2
mapfile -t second < <(packed 2 telltale telltaled python3-telltale)
run upgrading inside dpkg -i "${second[@]}"
[[ $(inside dpkg-query --show telltaled) == *-2 ]] || fail "telltaled is not upgraded"
start
run history telltale history --vehicle-id yellowfish --json
grep -q '"revision": *"\?1"\?' "$sandbox/output" || fail "the model of before the upgrade is gone"
finish

echo "== Removal takes all but configuration and data, purge the configuration"
run removing inside apt-get remove -y telltale telltaled python3-telltale
[[ ! -e $tree/usr/bin/telltaled && -z $(find "$tree/usr/lib/systemd" -name 'telltaled*') ]] || fail "removal leaves files"
[[ -e $tree/etc/telltale/telltaled.textproto && -e $tree/var/lib/telltale/models.sqlite ]] || fail "removal takes data"
run purging inside dpkg --purge telltale telltaled python3-telltale
left=$(find "$tree/etc" "$tree/usr" -iname '*telltale*')
[[ -z $left ]] || fail "purge leaves $left"
echo "the packages install, run, upgrade and go"
