#!/usr/bin/env python3
"""Alters each BlueBoat run in one known way at a time and prints, in Markdown, what telltale diagnose makes of it, by
the physical model of the boat's other runs, with all of those as references and without each of them in turn; which
sizes the unaltered runs are said to show, and what is made of runs altered by those; and what three references say.

Usage: bench/altered_real_runs.py [--built DIR] [--data DIR] [--held RUN]... [--threads N]

Runs telltale and blind_alter of build/release unless --built names another build folder, on the recordings of
../shared/data unless --data names another folder; without them it exits 77. --held names runs to alter; default: all.

Five runs do not suffice for a model and three references apart, so the other runs are both. telltale diagnose refuses
references that made the model, therefore the record of what made it is removed from model.json. What the tables show is
thus a floor of recordings that the model knows.
"""
import argparse
import collections
import json
import math
import pathlib
import subprocess
import sys
import tempfile

REFUSED = 3
SKIPPED = 77
VEHICLE = "docs/vehicles/blueboat.textproto"
# As in the vehicle file: neutral, full forward, full reverse.
PULSES = ["--port-pulses-us", "1511", "1911", "1111", "--starboard-pulses-us", "1511", "1111", "1911"]
THRUST_CURVE = ["Tf1", "Tf2", "Tr1", "Tr2", "df", "dr"]

DEGREE = math.pi / 180.0
# How blind_alter makes a parameter of an effect (SI).
OPTIONS = {
    ("heading_bias", "bias"): lambda value: ["--turn-heading-deg", str(value / DEGREE)],
    ("gnss_latency", "latency"): lambda value: ["--delay-fixes-s", str(value)],
    ("thruster_delay", "delay"): lambda value: ["--shift-commands-s", str(value)],
    ("thruster_imbalance", "port_loss"): lambda value: ["--weaken", "port" if value > 0 else "starboard", str(abs(value))],
    ("antenna_lever_arm", "forward"): lambda value: ["--move-antenna-m", str(value), "0"],
    ("antenna_lever_arm", "starboard"): lambda value: ["--move-antenna-m", "0", str(value)],
}

# What is altered: an effect by one parameter; none without an effect.
Alteration = collections.namedtuple("Alteration", "name effect parameter value")
ALTERATIONS = [
    Alteration("none", None, None, None),
    *(Alteration(f"heading {b:+d} degrees", "heading_bias", "bias", b * DEGREE) for b in (4, -4, 8, -8)),
    *(Alteration(f"fixes {s} s late", "gnss_latency", "latency", s) for s in (0.2, 0.4)),
    *(Alteration(f"commands {s} s late", "thruster_delay", "delay", s) for s in (0.15, 0.3)),
    *(Alteration(f"{side} {round(100 * e)} % weaker", "thruster_imbalance", "port_loss", e if side == "port" else -e)
      for side in ("port", "starboard") for e in (0.1, 0.2, 0.35)),
    *(Alteration(f"antenna 0.4 m {'' if way == 'forward' else 'to '}{way}", "antenna_lever_arm", way, 0.4)
      for way in ("forward", "starboard")),
]

# Whose smallest sizes are listed.
LISTED = ["heading_bias", "gnss_latency", "thruster_delay", "thruster_imbalance", "antenna_lever_arm", "current", "wind",
          "hull_fouling"]
# Of which an altered recording is made by the size that shows, and with which signs. A side that is weaker by as much is
# cut at full command nearly throughout.
BY_SIZE = {
    ("heading_bias", "bias"): {"+": 1, "-": -1},
    ("gnss_latency", "latency"): {"": 1},
    ("thruster_delay", "delay"): {"": 1},
    ("antenna_lever_arm", "forward"): {"": 1},
    ("antenna_lever_arm", "starboard"): {"": 1},
}

Answer = collections.namedtuple("Answer", "run alteration report")


def run(*command):
    """What a command says on standard error; None where the data cannot answer."""
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True)
    if done.returncode == REFUSED:
        return None
    if done.returncode != 0:
        sys.exit(f"altered_real_runs: {' '.join(map(str, command))} exited {done.returncode}: {done.stderr}")
    return done.stderr


class Boat:
    """The programs, the recordings and a folder for what they make of each other."""

    def __init__(self, arguments, root, folder):
        self.telltale = arguments.built / "client/telltale"
        self.alter = arguments.built / "tests/blind/blind_alter"
        self.vehicle = root / VEHICLE
        self.home = arguments.data / "blueboat"
        self.runs = sorted(log.name for log in self.home.iterdir() if log.is_dir())
        self.threads = arguments.threads
        self.folder = folder

    def model(self, runs):
        """model.json of these runs, without the record of what made it."""
        out = self.folder / ("+".join(runs) + ".json")
        if out.exists():
            return out
        logs = [part for name in runs for part in ("--log", self.home / name)]
        run(self.telltale, "identify", *logs, "--vehicle", self.vehicle, "--structure", "fossen", "--threads",
            self.threads, "--out", out)
        model = json.loads(out.read_text())
        model["provenance"].pop("recordings", None)
        out.write_text(json.dumps(model))
        return out

    def altered(self, name, alteration, model):
        """The log of a run, altered by the model's thrust curve, and what blind_alter says of it."""
        if alteration.effect is None:
            return self.home / name, ""
        curve = {p["symbol"]: p["estimate"] for p in json.loads(model.read_text())["parameters"]}
        log = self.folder / "log"
        options = OPTIONS[alteration.effect, alteration.parameter](alteration.value)
        said = run(self.alter, "--log", self.home / name, *options, *PULSES, "--thrust-curve",
                   *(curve[symbol] for symbol in THRUST_CURVE), "--out", log)
        return log, said

    def diagnosis(self, log, model, references):
        """report.json; None where it is refused."""
        out = self.folder / "report.json"
        out.unlink(missing_ok=True)
        logs = [part for name in references for part in ("--reference-log", self.home / name)]
        said = run(self.telltale, "diagnose", "--log", log, "--vehicle", self.vehicle, "--model", model, *logs,
                   "--threads", self.threads, "--out", out)
        return None if said is None else json.loads(out.read_text())


def without_each(answer):
    """The answers without each reference in turn, as telltale diagnose gives them, in the form of reports."""
    return [answer._replace(report={"verdict": i["verdict"], "causes": [{"effects": i.get("effects", [])}]})
            for i in answer.report.get("referenceInfluence", [])]


def is_named(report):
    return report["verdict"] in ("EXPLAINED", "PARTLY_EXPLAINED")


def sees_gap(report):
    return report["verdict"] not in ("NO_MATERIAL_GAP", "INSUFFICIENT_DATA")


def first_cause(report):
    causes = report.get("causes") or [{"effects": []}]
    return causes[0]


def cause_text(report):
    return " + ".join(first_cause(report)["effects"]) or "–"


def is_right(answer):
    cause = first_cause(answer.report)
    return answer.alteration.effect in cause["effects"] + cause.get("indistinguishable", [])


def size_text(answer):
    """The estimate of the parameter that is altered, the true value in brackets."""
    _, effect, parameter, value = answer.alteration
    for found in first_cause(answer.report).get("parameters", []):
        if (found.get("effect"), found["name"]) == (effect, parameter):
            return f"{found['estimate']:.2f} ({value:.2f}) {found.get('unit', '')}"
    return "–"


def power_text(answer):
    """The size from which on the altered log would show the true effect in 90 % of cases."""
    effects = {e["effect"]: e for e in answer.report.get("effects", [])}
    sizes = effects.get(answer.alteration.effect, {}).get("detectableSizes", [])
    for p in sizes:
        if p["name"] == answer.alteration.parameter:
            return f"{p['size']:.2f} {p['unit']}".removesuffix(" 1") if "size" in p else "beyond range"
    return "–"


def row(answer):
    report = answer.report
    gap, cause = report["gap"], first_cause(report)
    probability = f"{cause['probability']:.2f}" if "probability" in cause else "–"
    return (f"| {answer.run} | {answer.alteration.name} | {report['verdict']} | {gap['before']:.2f} "
            f"({gap['floorLimit']:.2f}) | {cause_text(report)} | {probability} | {size_text(answer)} | {power_text(answer)} |")


def counts(answers):
    """Answers that see a gap, that name the true effect and another, that hold the true one likeliest."""
    named = [a for a in answers if is_named(a.report)]
    right = sum(is_right(a) for a in named)
    first = sum(sees_gap(a.report) and is_right(a) for a in answers)
    return f"{sum(sees_gap(a.report) for a in answers)} | {right} | {len(named) - right} | {first} | {len(answers)}"


def print_by_run(answers):
    print("### Against all other runs\n")
    print("| run | alteration | verdict | gap (nominal limit) | first cause | probability | size (true size) | shows from |")
    print("|---|---|---|---|---|---|---|---|")
    for answer in answers:
        print(row(answer))


def print_by_alteration(answers):
    print("\n### Without each reference in turn\n")
    print("| alteration | gap seen | named rightly | named wrongly | true effect likeliest | diagnoses |")
    print("|---|---|---|---|---|---|")
    for alteration in ALTERATIONS:
        chosen = [other for a in answers if a.alteration is alteration for other in without_each(a)]
        print(f"| {alteration.name} | {counts(chosen)} |")


def print_steadiness(answers):
    print("\n### Verdicts without each reference\n")
    print("| run | alterations with one verdict whichever is left out | unaltered |")
    print("|---|---|---|")
    for name in sorted({a.run for a in answers}):
        verdicts = [[other.report["verdict"] for other in without_each(a)] for a in answers if a.run == name]
        steady = sum(len(set(v)) == 1 for v in verdicts)
        unaltered = ", ".join(f"{n} {v}" for v, n in collections.Counter(verdicts[0]).items())
        print(f"| {name} | {steady} of {len(verdicts)} | {unaltered} |")


def print_cuts(cuts):
    print("\n### Commands cut at full command\n")
    for line in cuts:
        print(f"- {line}")


def sizes_that_show(report, effect):
    """None of an effect that the report does not have."""
    return next((e for e in report["effects"] if e["effect"] == effect), {}).get("detectableSizes", [])


def quantity(size):
    return f"{size['size']:.2g} {size['unit']}".removesuffix(" 1") if "size" in size else "beyond range"


def print_smallest_sizes(unaltered):
    print("\n### Smallest sizes that show\n")
    print("| effect | " + " | ".join(a.run for a in unaltered) + " |\n|---" + "|---" * len(unaltered) + "|")
    for effect in LISTED:
        cells = [", ".join(map(quantity, sizes_that_show(a.report, effect))) for a in unaltered]
        print(f"| {effect} | " + " | ".join(cells) + " |")


def limit_of_days(report):
    """The gap that 99 % of nominal days stay below, (123)."""
    return f"{report['nominalDaysLimit']:.2f}" if "nominalDaysLimit" in report else "none"


def print_stated_sizes(answers):
    print("\n### Altered by the sizes that show\n")
    print("| run | alteration | verdict | gap (nominal days) | first cause |\n|---|---|---|---|---|")
    for answer in answers:
        report = answer.report
        print(f"| {answer.run} | {answer.alteration.name} | {report['verdict']} | "
              f"{report['gap']['before']:.2f} ({limit_of_days(report)}) | {cause_text(report)} |")


def print_three_references(runs, answers):
    print("\n### Unaltered, with three references\n")
    print("| run | " + " | ".join(f"without {name}" for name in runs) + " |\n|---" + "|---" * len(runs) + "|")
    for held in sorted({run for run, _ in answers}):
        cells = []
        for left_out in runs:
            report = answers.get((held, left_out))
            cells.append("–" if report is None else f"{report['verdict']}, {report['gap']['before']:.2f} "
                                                     f"({limit_of_days(report)})")
        print(f"| {held} | " + " | ".join(cells) + " |")


def of_stated_sizes(unaltered):
    """Alterations by the sizes that an unaltered run is said to show."""
    for (effect, name), signs in BY_SIZE.items():
        for size in sizes_that_show(unaltered.report, effect):
            if size["name"] != name or "size" not in size:
                continue
            for sign, factor in signs.items():
                yield Alteration(f"{effect} {name} {sign}{quantity(size)}", effect, name, factor * size["size"])


def further_diagnoses(boat, unaltered):
    """Of the same run altered by the sizes that it shows, and unaltered without each reference."""
    others = tuple(r for r in boat.runs if r != unaltered.run)
    model = boat.model(others)
    stated = []
    for alteration in of_stated_sizes(unaltered):
        report = boat.diagnosis(boat.altered(unaltered.run, alteration, model)[0], model, others)
        if report is not None:
            stated.append(Answer(unaltered.run, alteration, report))
    by_three = {(unaltered.run, left_out): boat.diagnosis(boat.home / unaltered.run, model,
                                                          [r for r in others if r != left_out]) for left_out in others}
    return stated, by_three


def diagnosed(boat, held):
    """The answers of one run, by alteration, and what was cut of its commands."""
    answers, cuts = [], []
    others = tuple(r for r in boat.runs if r != held)
    model = boat.model(others)
    for alteration in ALTERATIONS:
        log, said = boat.altered(held, alteration, model)
        if "cut" in said:
            cuts.append(f"{held}, {alteration.name}: {said.strip().removeprefix('blind_alter: ')}")
        report = boat.diagnosis(log, model, others)
        if report is not None:
            answers.append(Answer(held, alteration, report))
    return answers, cuts


def main():
    root = pathlib.Path(__file__).resolve().parent.parent
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--built", type=pathlib.Path, default=root / "build/release")
    parser.add_argument("--data", type=pathlib.Path, default=root / "../shared/data")
    parser.add_argument("--held", action="append")
    parser.add_argument("--threads", type=int, default=1)
    arguments = parser.parse_args()
    if not (arguments.data / "blueboat").is_dir():
        print(f"altered_real_runs: skipped, no recordings at {arguments.data / 'blueboat'}", file=sys.stderr)
        sys.exit(SKIPPED)
    answers, cuts, stated, by_three = [], [], [], {}
    with tempfile.TemporaryDirectory() as folder:
        boat = Boat(arguments, root, pathlib.Path(folder))
        for held in arguments.held or boat.runs:
            if held not in boat.runs:
                parser.error(f"--held {held}: there are {', '.join(boat.runs)}")
            of_run, cut_of_run = diagnosed(boat, held)
            answers += of_run
            cuts += cut_of_run
            for unaltered in (a for a in of_run if a.alteration.effect is None):
                stated_of_run, by_three_of_run = further_diagnoses(boat, unaltered)
                stated += stated_of_run
                by_three |= by_three_of_run
    if not answers:
        sys.exit("altered_real_runs: every run is refused; telltale diagnose says why")
    print_by_run(answers)
    print_by_alteration(answers)
    print_steadiness(answers)
    print_smallest_sizes([a for a in answers if a.alteration.effect is None])
    print_stated_sizes(stated)
    print_three_references(boat.runs, by_three)
    print_cuts(cuts)


if __name__ == "__main__":
    main()
