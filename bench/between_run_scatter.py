#!/usr/bin/env python3
"""Does the scatter of real runs match the standard errors that are published with them? Identifies every recording of
every boat that has several, each by itself, and prints by coefficient, in Markdown, the standard deviation of its
estimates between the runs over the root mean square of their standard errors. One is what the bounds promise of a boat
that is the same in every run.

Usage: bench/between_run_scatter.py [--built DIR] [--data DIR] [--estimator NAME]...

Runs telltale of build/release unless --built names another build folder, on the recordings of ../shared/data unless
--data names another folder, with weak-iv and one-step unless --estimator names others.
"""
import argparse
import json
import math
import pathlib
import statistics
import subprocess
import sys
import tempfile

REFUSED = 3


def identify(telltale, log, vehicle, estimator, out):
    """The coefficients that are bounded, by equation and regressor: estimate and standard error."""
    run = subprocess.run([telltale, "identify", "--log", log, "--vehicle", vehicle, "--estimator", estimator, "--out", out],
                         capture_output=True, text=True)
    if run.returncode == REFUSED:
        return {}
    if run.returncode != 0:
        sys.exit(f"between_run_scatter: {log}: telltale identify exited {run.returncode}: {run.stderr}")
    model = json.loads(pathlib.Path(out).read_text())
    return {(c["equation"], c["regressor"]): (c.get("estimate", 0.0), c["standardError"]) for c in model["coefficients"]
            if isinstance(c.get("standardError"), (int, float)) and c["standardError"] > 0.0}


def ratio(runs):
    """Standard deviation between runs over the root mean square of the standard errors."""
    return statistics.stdev(e for e, _ in runs) / math.sqrt(statistics.fmean(s * s for _, s in runs))


def weighted(runs):
    """The same with every run weighted by its own standard error, so that the widest does not decide alone."""
    weights = [1.0 / (s * s) for _, s in runs]
    mean = sum(w * e for w, (e, _) in zip(weights, runs)) / sum(weights)
    return math.sqrt(sum(w * (e - mean) ** 2 for w, (e, _) in zip(weights, runs)) / (len(runs) - 1))


def by_coefficient(models):
    """Of each coefficient that at least two runs bound, what they say of it."""
    order = dict.fromkeys(key for model in models for key in model)
    found = {key: [model[key] for model in models if key in model] for key in order}
    rank = {"SURGE": 0, "SWAY": 1, "YAW": 2}
    return {key: runs for key, runs in sorted(found.items(), key=lambda item: rank[item[0][0]]) if len(runs) > 1}


def cells(runs):
    if not runs:
        return "- | - | - | -"
    return f"{len(runs)} | {statistics.stdev(e for e, _ in runs):.3g} | {ratio(runs):.2f} | {weighted(runs):.2f}"


def escaped(regressor):
    return regressor.replace("|", "\\|")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    root = pathlib.Path(__file__).resolve().parent.parent
    parser.add_argument("--built", type=pathlib.Path, default=root / "build/release")
    parser.add_argument("--data", type=pathlib.Path, default=root.parent / "shared/data")
    parser.add_argument("--estimator", action="append")
    arguments = parser.parse_args()
    estimators = arguments.estimator or ["weak-iv", "one-step"]
    if not arguments.data.is_dir():
        sys.exit(f"between_run_scatter: no recordings at {arguments.data}")
    summary = []
    with tempfile.TemporaryDirectory() as folder:
        for boat in sorted(path for path in arguments.data.iterdir() if path.is_dir()):
            logs = sorted(path for path in boat.iterdir() if path.is_dir())
            if len(logs) < 2:
                continue
            vehicle = root / f"docs/vehicles/{boat.name}.textproto"
            found = {}
            for estimator in estimators:
                models = [identify(arguments.built / "client/telltale", log, vehicle, estimator, f"{folder}/model.json")
                          for log in logs]
                found[estimator] = by_coefficient(models)
                summary.append((boat.name, estimator, [runs for (_, regressor), runs in found[estimator].items()
                                                       if regressor != "1"]))
            print(f"### {boat.name}, {len(logs)} runs\n")
            print("| coefficient | " + " | ".join(f"runs | {e}: sd between | ratio | weighted"
                                                   for e in estimators) + " |")
            print("|---|" + "---|" * 4 * len(estimators))
            for key in dict.fromkeys(key for e in estimators for key in found[e]):
                print(f"| {key[0]} {escaped(key[1])} | " + " | ".join(cells(found[e].get(key)) for e in estimators) + " |")
            print(flush=True)
    print("### All but the constants\n")
    print("| boat | estimator | coefficients | ratio: median | quartiles | above 2 | weighted: median | quartiles | above 2 |")
    print("|---|---|---|---|---|---|---|---|---|")
    for boat, estimator, all_runs in summary:
        row = [boat, estimator, str(len(all_runs))]
        for of in (ratio, weighted):
            values = sorted(of(runs) for runs in all_runs)
            if len(values) < 2:
                row += ["-"] * 3
                continue
            low, middle, high = statistics.quantiles(values, n=4, method="inclusive")
            row += [f"{middle:.2f}", f"{low:.2f} to {high:.2f}", str(sum(value > 2.0 for value in values))]
        print("| " + " | ".join(row) + " |")


if __name__ == "__main__":
    main()
