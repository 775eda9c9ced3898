#!/usr/bin/env bash
# deploy/install sets up a fleet of more than one host with DDS Security unless told otherwise. From what it
# installs in three trees, as the hosts of daemon, boat and client, a fleet works on this machine, over its network
# interface, and whoever has no credentials finds no daemon.
set -euo pipefail

source=$(cd "$(dirname "$0")/../.." && pwd)
install=$source/deploy/install
[[ -n $(find /usr/lib -name libdds_security_auth.so -print -quit) ]] || exit 77
[[ $EUID == 0 ]] || { echo "skipped: needs root, who owns what is installed"; exit 77; }
folder=$(mktemp -d)
daemon=''
stop() {
  [[ -z $daemon ]] || kill "$daemon" 2> /dev/null || true
  wait
  rm -rf "$folder"
}
trap stop EXIT
fail() {
  echo "FAILED: $1" >&2
  cat "$folder"/out "$folder"/log >&2 2> /dev/null || true
  exit 1
}
expect_code() {  # CODE COMMAND...
  local code=0
  "${@:2}" > "$folder/out" 2>&1 || code=$?
  [[ $code == "$1" ]] || fail "exit $code, not $1: ${*:2}"
}
says() { grep -qF -- "$1" "$folder/out" || fail "the output has no '$1'"; }

mkdir "$folder/vehicles" "$folder/empty"
cp "$source/deploy/sample/yellowfish.textproto" "$folder/vehicles"

run_cpack() {
  cpack --config "$TELLTALE_BUILT/CPackConfig.cmake" -B "$folder/packages" -D "CPACK_COMPONENTS_ALL=telltale;telltaled"
}
expect_code 0 run_cpack

echo "== Wrong use"
expect_code 2 "$install" --root "$folder/x"
says "--vehicles DIR names"
expect_code 2 "$install" --root "$folder/x" --vehicles "$folder/empty"
says "holds no vehicle file"
expect_code 2 "$install" --root "$folder/x" --vehicles "$folder/vehicles" --client c
says "--client needs --hub"
expect_code 2 "$install" --root "$folder/x" --vehicles "$folder/vehicles" --insecure
says "--insecure needs --hub"
expect_code 2 "$install" --root "$folder/x" --vehicles "$folder/vehicles" --hub 192.0.2.1 --domain 102
says "--domain 102"
expect_code 2 "$install" --root "$folder/x" --vehicles "$folder/vehicles" --hub 192.0.2.1 --client yellowfish --daemon yellowfish
says "'yellowfish' is that of another"
expect_code 2 "$install" --root "$folder/x" --vehicles "$folder/vehicles" --packages "$folder/empty"
says "make it by deploy/packages"
expect_code 2 "$install" --root "$folder/x" --join "$folder/empty"
says "is no folder of a host"

echo "== What would be done"
fleet=(--vehicles "$folder/vehicles" --hub 192.0.2.1 --credentials "$folder/fleet" --packages "$folder/packages")
expect_code 0 "$install" --dry-run --root "$folder/x" "${fleet[@]}"
says "security.conf"
expect_code 0 "$install" --dry-run --root "$folder/x" "${fleet[@]}" --insecure
! grep -q "security.conf" "$folder/out" || fail "--insecure has credentials"
says "warning: without DDS Security"
[[ ! -e $folder/x && ! -e $folder/fleet ]] || fail "--dry-run does something"

echo "== One host"
expect_code 0 "$install" --root "$folder/alone" --vehicles "$folder/vehicles" --packages "$folder/packages"
cmp "$source/deploy/cyclonedds/loopback.xml" "$folder/alone/etc/telltale/cyclonedds.xml" || fail "DDS leaves the machine"
[[ ! -e $folder/alone/etc/telltale/security ]] || fail "one host has credentials"
[[ -L $folder/alone/etc/systemd/system/multi-user.target.wants/telltaled.service ]] || fail "the unit is not enabled"
echo "http { port: 8481 }" > "$folder/alone/etc/telltale/telltaled.textproto"
expect_code 0 "$install" --root "$folder/alone" --vehicles "$folder/vehicles" --packages "$folder/packages"
grep -q 8481 "$folder/alone/etc/telltale/telltaled.textproto.~1~" || fail "a changed configuration is lost"
expect_code 0 "$install" --root "$folder/alone" --vehicles "$folder/vehicles" --packages "$folder/packages"
[[ ! -e $folder/alone/etc/telltale/telltaled.textproto.~2~ ]] || fail "a file that is as it should be is kept twice"

echo "== Three hosts"
address=$(hostname -I | tr ' ' '\n' | grep -m 1 -F .) || { echo "skipped: no network interface"; exit 77; }
# A domain whose ports nobody uses: the hub stands at a port that is known.
taken() { grep -qiE ":($(printf '%04X|%04X' $((7410 + 250 * $1)) $((7411 + 250 * $1)))) " /proc/net/udp; }
domain=$((70 + $$ % 30))
while taken "$domain"; do domain=$((domain == 101 ? 70 : domain + 1)); done
fleet=(--vehicles "$folder/vehicles" --hub "$address" --client operator --credentials "$folder/fleet" --packages "$folder/packages" --domain "$domain")
expect_code 0 "$install" --root "$folder/shore" "${fleet[@]}"
expect_code 0 "$install" --root "$folder/boat" --packages "$folder/packages" --join "$folder/fleet/yellowfish"
expect_code 0 "$install" --root "$folder/client" --packages "$folder/packages" --join "$folder/fleet/operator"
others=$(find "$folder"/{shore,boat,client}/etc -name key.pem -not -perm 600)
[[ -z $others ]] || fail "others can read $others"
[[ ! -e $folder/shore/etc/telltale/security/authority ]] || fail "the authority is on the daemon's host"

# The daemon, as systemd starts it by the drop-in.
drop_in=$folder/shore/etc/systemd/system/telltaled.service.d/security.conf
said=$(systemd-analyze verify --man=no --root="$folder/shore" telltaled.service 2>&1 | grep -F "$drop_in" || true)
[[ -z $said ]] || fail "systemd does not take the drop-in: $said"
handed=$folder/credentials
mkdir "$handed"
while IFS=: read -r name path; do
  install -m 400 "$folder/shore$path" "$handed/$name"
done < <(sed -n 's/^LoadCredential=//p' "$drop_in")
mapfile -t environment < <(sed -n 's/^Environment=//p' "$drop_in" |
  sed "s|%d|$handed|g; s|file:///etc|file://$folder/shore/etc|")
programs() { find "$folder/$1" -type f -path "*/bin/$2"; }
configuration=$folder/shore/etc/telltale/telltaled.textproto
printf 'state_directory: "%s/state"\n' "$folder" >> "$configuration"
sed -i 's/^http {}/http { port: 0 }/' "$configuration"
touch "$folder/log"
serve() {  # VARIABLE=VALUE...: the daemon, with this environment
  env "$@" "$(programs shore telltaled)" --config "$configuration" > "$folder/log" 2>&1 &
  daemon=$!
  grep -q -m 1 "serving 1 vehicles" < <(timeout 60 tail -n +1 -f "$folder/log" --pid "$daemon" 2> /dev/null) || fail "telltaled does not serve"
}
serve "${environment[@]}"

# at HOST COMMAND...: telltale, with the environment that was installed there.
at() {
  local uri
  uri=$(sed "s|file:///etc|file://$folder/$1/etc|g; s|^CYCLONEDDS_URI=||" "$folder/$1/etc/telltale/environment")
  env TELLTALE_CREDENTIALS="$(dirname "$(find "$folder/$1/etc" -name key.pem)")" CYCLONEDDS_URI="$uri" \
    "$(programs "$1" telltale)" "${@:2}" --domain "$domain"
}
expect_code 0 at boat replay --log "$source/deploy/sample" --vehicle-id yellowfish --speed 200
expect_code 0 at client identify --vehicle-id yellowfish
says "revision 1"
expect_code 1 at boat list --timeout 4  # a boat may not ask

echo "== Without credentials"
stranger() {
  env CYCLONEDDS_URI="file://$folder/client/etc/telltale/cyclonedds.xml" "$(programs client telltale)" "$@" --domain "$domain"
}
expect_code 1 stranger list --timeout 4
says "no daemon answers"
expect_code 1 stranger replay --log "$source/deploy/sample" --vehicle-id yellowfish --timeout 4
kill "$daemon"
wait "$daemon" || fail "telltaled does not end in order"
serve CYCLONEDDS_URI="file://$folder/shore/etc/telltale/cyclonedds.xml"
expect_code 0 stranger list  # so it was the credentials that the stranger lacked
echo "a fleet of three hosts works with DDS Security, and nobody without credentials takes part"
