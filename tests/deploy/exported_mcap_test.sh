#!/usr/bin/env bash
# What `telltale export --format mcap` writes is read by @mcap/core, from npm, and holds what `--format csv`
# writes. TELLTALE_BUILT names the build folder. Skipped where npm gives no reader; in CI that is a failure.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
telltale=$TELLTALE_BUILT/client/telltale
reader=$TELLTALE_BUILT/mcap_reader
"$root/tests/deploy/from_npm" "$root/tests/client/recording/foreign" "$reader"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/log"
for channel in gnss heading thrusters; do
  awk -F, 'NR == 1 || $1 <= 300' "$root/deploy/sample/$channel.csv" > "$work/log/$channel.csv"
done
boat=$root/deploy/sample/yellowfish.textproto
for structure in static fossen; do
  "$telltale" identify --log "$work/log" --vehicle "$boat" --structure "$structure" \
    --out "$work/model.json" > /dev/null
  for format in csv mcap; do
    "$telltale" export --model "$work/model.json" --vehicle "$boat" --log "$work/log" \
      --format "$format" --horizon 5 --out "$work/$structure.$format" > /dev/null
  done
  node "$reader/read_mcap.mjs" "$work/$structure.mcap" > "$work/$structure.lines"
done

python3 - "$work" <<'PYTHON'
import csv, json, math, pathlib, sys

work = pathlib.Path(sys.argv[1])
MOTION = ["north_m", "east_m", "heading_deg", "u_mps", "v_mps", "r_radps"]
faults = []


def expect(holds, what):
    if not holds:
        faults.append(what)


for structure in ("static", "fossen"):
    rows = list(csv.DictReader(open(work / f"{structure}.csv" / "series.csv", newline="")))
    coefficients = list(csv.DictReader(open(work / f"{structure}.csv" / "coefficients.csv", newline="")))
    topics = {}
    for line in open(work / f"{structure}.lines"):
        message = json.loads(line)
        topics.setdefault(message["topic"], []).append(message)
    columns = {"measured": ("", MOTION + ["port", "starboard"]), "free_run": ("free_run_", MOTION),
               "residuals": ("residual_", MOTION[3:])}
    for topic, (prefix, fields) in columns.items():
        wanted = [row for row in rows if row[prefix + fields[0]] != ""]
        got = topics.get(f"/telltale/{topic}", [])
        expect(len(got) == len(wanted) > 1000, f"{structure}: {len(got)} of {topic}, not {len(wanted)}")
        for row, message in zip(wanted, got):
            same = all(math.isclose(float(row[prefix + f]), message["data"][f], abs_tol=1e-12) for f in fields)
            on_time = abs(float(row["time_s"]) - int(message["timeNs"]) * 1e-9) < 1e-6
            if not (same and on_time):
                faults.append(f"{structure}: {topic} at {row['time_s']} s: {row} but {message}")
                break
    # A free run errs little after one step and its residual is what it misses then.
    stray = [abs(float(r["residual_u_mps"])) for r in rows if r["residual_u_mps"]]
    expect(sum(stray) / len(stray) < 0.05, f"{structure}: residuals of surge are {sum(stray) / len(stray)} m/s")
    fix = topics["/telltale/position"][0]
    expect(fix["schema"] == "foxglove.LocationFix", "the positions' schema")
    first = next(csv.DictReader(open(work / "log" / "gnss.csv", newline="")))
    expect(abs(fix["data"]["latitude"] - float(first["latitude_deg"])) < 1e-4, "the first position")
    told = topics["/telltale/coefficients"][0]["data"]["coefficients"]
    expect([c["symbol"] for c in told] == [c["symbol"] for c in coefficients], f"{structure}: coefficients")
    expect(all(c["lower"] <= c["estimate"] <= c["upper"] for c in told if "lower" in c and "upper" in c),
           f"{structure}: bounds")
for fault in faults:
    print("FAILED:", fault, file=sys.stderr)
sys.exit(1 if faults else 0)
PYTHON
echo "@mcap/core reads what export writes"
