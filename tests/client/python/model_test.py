"""Models are those of the command, recover a known boat, and go in and out as arrays."""

import csv
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading
import unittest

import numpy as np
import telltale
import twin

# What the simulated boat has, docs/reference/yellowfish-twin.md, whose numbers are the paper's.
TRUTH = {
    "SURGE f:d^2": -0.03625,
    "SURGE f:d": 0.35075,
    "SURGE r:d^2": 0.02157,
    "SURGE r:d": 0.20870,
    "SWAY f:d^2": -0.07225,
    "SWAY f:d": -0.13425,
    "SWAY r:d^2": -0.11825,
    "SWAY r:d": -0.11825,
    "YAW f:d^2": -0.40375,
    "YAW f:d": 1.00500,
    "YAW r:d^2": 0.03225,
    "YAW r:d": 0.59800,
}
FAST = {"estimator": "one-step", "bootstrap": 0}
FAST_OPTIONS = ("--estimator", "one-step", "--bootstrap", "0")


class ModelTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        cls.sample = telltale.load(twin.SAMPLE, vehicle=twin.BOAT)
        cls.other_log = twin.record(cls.folder / "other", duration=200, seed=2)
        cls.other = telltale.load(cls.other_log, vehicle=twin.BOAT)
        cls.model = telltale.identify(cls.sample, **FAST)
        cls.model_file = cls.folder / "model.json"
        cls.model.save(cls.model_file)

    # ---- identify --------------------------------------------------------------------------------

    def test_a_model_is_that_of_the_command(self):
        for arguments, options in (
            ({}, ()),
            (FAST, FAST_OPTIONS),
            ({"structure": "dynamic", "level": 0.9, "dead_zone": (0.02, -0.03), **FAST},
             ("--structure", "dynamic", "--level", "0.9", "--dead-zone", "0.02,-0.03", *FAST_OPTIONS)),
        ):
            with self.subTest(arguments):
                model = telltale.identify(self.sample, **arguments)
                said = twin.answer("identify", "--log", twin.SAMPLE, "--vehicle", twin.BOAT, *options)
                self.assertEqual(model.to_dict(), said)

    def test_several_recordings_give_one_model(self):
        model = telltale.identify([self.sample, self.other], **FAST)
        said = twin.answer("identify", "--log", twin.SAMPLE, "--log", self.other_log, "--vehicle", twin.BOAT, *FAST_OPTIONS)
        self.assertEqual(model.to_dict(), said)

    def test_the_known_boat_is_recovered(self):
        model = telltale.identify(self.sample, structure="static", level=0.999)
        for name, truth in TRUTH.items():
            with self.subTest(name):
                self.assertLessEqual(model[name].lower, truth)
                self.assertGreaterEqual(model[name].upper, truth)

    def test_arrays_stand_in_the_order_of_names(self):
        model = self.model
        self.assertEqual([c.name for c in model.coefficients], model.names)
        np.testing.assert_array_equal(model.values, [c.estimate for c in model.coefficients])
        np.testing.assert_array_equal(model.bounds, [[c.lower, c.upper] for c in model.coefficients])
        bounded = np.isfinite(model.standard_errors)
        self.assertTrue(bounded.any())
        np.testing.assert_allclose(np.sqrt(np.diag(model.covariance))[bounded], model.standard_errors[bounded])
        np.testing.assert_allclose(model.covariance, model.covariance.T)
        with self.assertRaises(KeyError):
            model["SURGE no such"]

    def test_a_model_just_identified_is_scored_on_data_set_aside(self):
        self.assertLess(self.model.held_out.free_run[0].velocity["surge"].rmse, 0.1)
        self.assertIsNone(telltale.load_model(self.model_file).held_out)

    def test_a_saved_model_is_read_back(self):
        self.assertEqual(telltale.load_model(self.model_file).to_json(), self.model.to_json())
        self.assertEqual(telltale.Model.from_json(self.model.to_json()).to_dict(), self.model.to_dict())

    def test_progress_is_told(self):
        stages = []
        telltale.identify(self.other, progress=lambda stage, share: stages.append((stage, share)), **FAST)
        self.assertTrue(stages)
        self.assertTrue(all(0.0 <= share <= 1.0 for _, share in stages))

    def test_what_progress_raises_ends_the_computation(self):
        def give_up(stage, share):
            raise LookupError(stage)

        with self.assertRaises(LookupError):
            telltale.identify(self.other, progress=give_up, **FAST)

    def test_other_threads_run_during_a_computation(self):
        # No thread is made to yield, so the other one counts only while the computation lets it.
        interval = sys.getswitchinterval()
        self.addCleanup(sys.setswitchinterval, interval)
        sys.setswitchinterval(1000.0)
        stop, counted = threading.Event(), [0]

        def count():
            while not stop.wait(1e-4):
                counted[0] += 1

        other = threading.Thread(target=count)
        other.start()
        before = counted[0]
        telltale.identify(self.sample, **FAST)
        during = counted[0] - before
        stop.set()
        other.join()
        self.assertGreater(during, 10)

    def test_ctrl_c_ends_a_computation_and_leaves_the_recording(self):
        # queue.put runs no Python of the main thread, which alone would notice the signal.
        script = f"""
import queue, threading
import telltale
recording = telltale.load({str(self.other_log)!r}, vehicle={str(twin.BOAT)!r})
told = queue.SimpleQueue()
threading.Thread(target=lambda: print("computes", bool(told.get()), flush=True), daemon=True).start()
try:
    telltale.identify(recording, structure="static", check_coverage=1000, progress=told.put)
except KeyboardInterrupt:
    print("interrupted", len(recording.fix_time_s), flush=True)
"""
        with subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True) as run:
            try:
                self.assertEqual(run.stdout.readline(), "computes True\n")
                run.send_signal(signal.SIGINT)
                said = run.communicate(timeout=60)[0].splitlines()
            finally:
                run.kill()
        self.assertEqual(said[-1], f"interrupted {len(self.other.fix_time_s)}")

    # ---- what is wrong ---------------------------------------------------------------------------

    def test_arguments_out_of_range_are_named_in_the_words_of_the_command(self):
        for arguments, options in (
            ({"level": 0.2}, ("--level", "0.2")),
            ({"bootstrap": 50}, ("--bootstrap", "50")),
            ({"sampling_period": 9.0}, ("--sampling-period", "9")),
            ({"replicates": 40, "estimator": "one-step"}, ("--replicates", "40", "--estimator", "one-step")),
            ({"structure": "fossen", "include_rr": True}, ("--structure", "fossen", "--include-rr")),
            ({"dead_zone": (0.5, 0.0)}, ("--dead-zone", "0.5,0")),
        ):
            with self.subTest(arguments), self.assertRaises(telltale.InputError) as raised:
                telltale.identify(self.other, **arguments)
            said = twin.telltale("identify", "--log", self.other_log, "--vehicle", twin.BOAT, *options)
            self.assertEqual(said.returncode, 2)
            self.assertIn(twin.words(str(raised.exception)), twin.words(said.stderr))

    def test_names_that_there_are_not_are_told_with_those_there_are(self):
        for argument in ("structure", "estimator", "preset", "parameterization", "bootstrap_kind", "interval", "recording_bias"):
            with self.subTest(argument), self.assertRaisesRegex(telltale.InputError, f"^{argument}: nonsense is none of "):
                telltale.identify(self.other, **{argument: "nonsense"})
        with self.assertRaisesRegex(telltale.InputError, "dead_zone: nonsense is none of identify"):
            telltale.identify(self.other, dead_zone="nonsense")

    def test_a_folder_needs_a_vehicle(self):
        bare = telltale.load(self.other_log)
        self.assertIsNone(bare.vehicle)
        with self.assertRaisesRegex(telltale.InputError, "vehicle is required: .*other is a folder of CSV files"):
            telltale.identify(bare)
        self.assertEqual(telltale.identify(bare, vehicle=twin.BOAT, **FAST).vehicle_id, "yellowfish")

    def test_recordings_of_different_vehicles_are_told(self):
        stranger = telltale.load(self.other_log, vehicle=telltale.Vehicle("stranger", propeller_separation_m=0.7))
        with self.assertRaisesRegex(telltale.InputError, "state different ones"):
            telltale.identify([self.sample, stranger], **FAST)
        with self.assertRaisesRegex(telltale.InputError, "recordings: give one at least"):
            telltale.identify([])

    def test_none_is_no_recording(self):
        for recordings in (None, [None], [self.other, None]):
            with self.subTest(recordings):
                for call in (telltale.diagnose, telltale.validate):
                    with self.assertRaisesRegex(telltale.InputError, "recordings: None is no recording"):
                        call(self.model, recordings)
                with self.assertRaisesRegex(telltale.InputError, "recordings: None is no recording"):
                    telltale.identify(recordings, **FAST)
        with self.assertRaisesRegex(telltale.InputError, "references: None is no recording"):
            telltale.diagnose(self.model, self.other, [None])

    def test_results_say_what_they_are(self):
        self.assertEqual(repr(self.model.draws(3)), f"<telltale.Draws: 3 draws of {len(self.model.names)} coefficients>")
        self.assertEqual(repr(telltale.simulate(self.model, [0, 1], np.zeros((2, 2)), step=0.5)), "<telltale.Track of 3 instants, 0 s to 1 s>")

    def test_what_the_data_cannot_tell_is_refused_in_the_words_of_the_command(self):
        short = twin.record(self.folder / "short", duration=10)
        with self.assertRaises(telltale.DataCannotTell) as raised:
            telltale.identify(telltale.load(short, vehicle=twin.BOAT), **FAST)
        said = twin.telltale("identify", "--log", short, "--vehicle", twin.BOAT, *FAST_OPTIONS)
        self.assertEqual(said.returncode, 3)
        for part in (raised.exception.subject, raised.exception.reason, raised.exception.advice):
            self.assertTrue(part)
            self.assertIn(twin.words(part), twin.words(said.stderr))

    def test_a_model_that_is_none_is_an_input_error(self):
        for text in ("{}", "no JSON", '{"structure": 3}'):
            with self.subTest(text), self.assertRaises(telltale.InputError):
                telltale.Model.from_json(text)

    def test_a_model_that_cannot_be_written_is_an_os_error(self):
        with self.assertRaises(OSError):
            self.model.save(self.folder / "no" / "such" / "model.json")

    # ---- draws -----------------------------------------------------------------------------------

    def test_draws_are_those_of_the_command(self):
        draws = self.model.draws(50, seed=7)
        out = self.folder / "exported"
        run = twin.telltale("export", "--model", self.model_file, "--vehicle", twin.BOAT, "--format", "mss", "--draws", 50, "--seed", 7, "--out", out)
        self.assertEqual(run.returncode, 0, run.stderr)
        with open(out / "draws.csv", encoding="utf-8") as file:
            header, *rows = csv.reader(file)
        self.assertEqual(draws.names, header)
        np.testing.assert_array_equal(draws.values, np.array(rows, dtype=float))

    def test_draws_scatter_as_the_covariance_says(self):
        draws = self.model.draws(20000, seed=1)
        bounded = np.isfinite(self.model.standard_errors)
        # The standard deviation of 20000 normal draws has a relative standard error of 0.5 %.
        np.testing.assert_allclose(draws.values.std(axis=0)[bounded], self.model.standard_errors[bounded], rtol=0.03)
        np.testing.assert_array_equal(self.model.draws(5, seed=1).values, draws.values[:5])
        with self.assertRaisesRegex(telltale.InputError, r"count: 0 is outside \[1, 100000\]"):
            self.model.draws(0)

    # ---- validate --------------------------------------------------------------------------------

    def test_scores_are_those_of_the_command(self):
        scores = telltale.validate(self.model, self.other, horizons=[1, 5])
        said = twin.answer("validate", "--model", self.model_file, "--log", self.other_log, "--vehicle", twin.BOAT, "--horizon", 1, "--horizon", 5)
        self.assertEqual(scores.to_dict(), said)
        self.assertEqual([run.horizon_s for run in scores.free_run], [1.0, 5.0])
        self.assertEqual(scores.one_step["yaw"].r2, said["oneStep"]["yaw"]["r2"])

    # ---- simulate --------------------------------------------------------------------------------

    def test_a_simulation_is_that_of_the_command(self):
        still = telltale.Vehicle("yellowfish", propeller_separation_m=0.7)  # its antenna above the origin
        boat = self.folder / "still.textproto"
        boat.write_text(str(still))
        out = self.folder / "simulated"
        run = twin.telltale("simulate", "--model", self.model_file, "--vehicle", boat, "--commands", self.other_log / "thrusters.csv",
                            "--noise-position", 0, "--noise-heading", 0, "--out", out)
        self.assertEqual(run.returncode, 0, run.stderr)
        measured = telltale.load(out, vehicle=still)
        track = telltale.simulate(self.model, self.other.command_time_s, self.other.commands)
        self.assertEqual(len(track), len(track.time_s))
        np.testing.assert_allclose(np.interp(measured.fix_time_s, track.time_s, track.north_m), measured.north_m, atol=2e-3)
        np.testing.assert_allclose(np.interp(measured.fix_time_s, track.time_s, track.east_m), measured.east_m, atol=2e-3)

    def test_a_simulation_follows_its_velocities(self):
        track = telltale.simulate(self.model, self.other.command_time_s, self.other.commands, step=0.01)
        heading = track.heading_rad
        north = np.cos(heading) * track.surge - np.sin(heading) * track.sway
        east = np.sin(heading) * track.surge + np.cos(heading) * track.sway
        for position, velocity in ((track.north_m, north), (track.east_m, east), (heading, track.yaw_rate)):
            steps = (velocity[1:] + velocity[:-1]) / 2 * np.diff(track.time_s)
            np.testing.assert_allclose(np.diff(position), steps, atol=1e-5)
        self.assertEqual((track.north_m[0], track.surge[0], heading[0]), (0.0, 0.0, 0.0))

    def test_commands_that_do_not_fit_are_named(self):
        for time_s, commands, says in (
            ([], np.zeros((0, 2)), "time_s: give one command at least"),
            ([0, 1], np.zeros((3, 2)), "commands: give an array of 2 rows"),
            ([0, 0], np.zeros((2, 2)), "time_s: 0 of row 1 does not come after"),
            ([0, 1e9], np.zeros((2, 2)), r"time_s: the commands last 1e\+09 s, more than the 86400 s"),
            ([0, 1], [[0, 0], [0, 1.5]], r"commands: those of row 1 .*\[-1, 1\]"),
            ([0, 1], [[0, 0], [0, np.nan]], r"commands: those of row 1 .*\[-1, 1\]"),
        ):
            with self.subTest(says), self.assertRaisesRegex(telltale.InputError, says):
                telltale.simulate(self.model, time_s, commands)
        with self.assertRaisesRegex(telltale.InputError, r"step: 5 is outside \[0.001, 1\]"):
            telltale.simulate(self.model, [0, 1], np.zeros((2, 2)), step=5)

    # ---- gain, compare, export -------------------------------------------------------------------

    def test_gains_are_those_of_the_command(self):
        for commands, options in ((None, ()), ([[0.5, 0.5], [0.5, -0.2]], ("--delta", "0.5,0.5", "--delta", "0.5,-0.2"))):
            gains = telltale.gain(self.model, commands)
            said = twin.answer("gain", "--model", self.model_file, *options)
            self.assertEqual(gains.to_dict(), said)
            self.assertEqual(len(gains), len(said["gains"]))
            for i, command in enumerate(said["gains"]):
                surge = command["surge"]["continuous"]
                self.assertEqual(list(gains.commands[i]), [command.get("port", 0.0), command.get("starboard", 0.0)])
                self.assertEqual(gains.accelerations[i, 0], surge["estimate"])
                self.assertEqual(list(gains.bounds[i, 0]), [surge["interval"]["lower"], surge["interval"]["upper"]])
        with self.assertRaisesRegex(telltale.InputError, r"commands: those of row 0 .*\[-1, 1\]"):
            telltale.gain(self.model, [[1.5, 0]])
        with self.assertRaisesRegex(telltale.InputError, "commands: give an array of two columns"):
            telltale.gain(self.model, [0.5, 0.5])

    def test_a_comparison_is_that_of_the_command(self):
        other = telltale.identify(self.other, **FAST)
        other_file = self.folder / "other.json"
        other.save(other_file)
        change = telltale.compare(self.model, other)
        self.assertEqual(change.to_dict(), twin.answer("compare", "--model", self.model_file, "--model", other_file))
        self.assertEqual(change.differ, change.p_value < 0.01)
        self.assertIn("by their clocks the windows of the two overlap", change.notes[0])
        first = change.coefficients[0]
        self.assertAlmostEqual(first.sigmas, first.difference / first.standard_error)
        with self.assertRaises(telltale.DataCannotTell):
            telltale.compare(self.model, telltale.identify(self.other, structure="dynamic", **FAST))

    def test_exports_are_those_of_the_command(self):
        for format, with_log, options in (
            ("mss", False, {"draws": 5, "seed": 3}),
            ("csv", True, {"horizon": 5}),
            ("mcap", True, {}),
        ):
            with self.subTest(format):
                mine, theirs = self.folder / f"mine-{format}", self.folder / f"theirs-{format}"
                for folder in (mine, theirs):
                    folder.mkdir()
                recording = self.other if with_log else None
                files = telltale.export(self.model, mine, format, twin.BOAT, recording, **options)
                named = [part for name, value in options.items() for part in (f"--{name}", value)]
                if with_log:
                    named += ["--log", self.other_log]
                run = twin.telltale("export", "--model", self.model_file, "--vehicle", twin.BOAT, "--format", format,
                                    "--out", theirs, *named)
                self.assertEqual(run.returncode, 0, run.stderr)
                self.assertEqual([file.name for file in files], [pathlib.Path(line).name for line in run.stdout.split()])
                for file in files:
                    self.assertEqual(file.read_bytes(), (theirs / file.name).read_bytes(), file)

    def test_exports_that_do_not_fit_are_named(self):
        for says, arguments in (
            ("format", {"format": "xml"}),
            ("recording: csv shows the model over a recording", {"format": "csv"}),
            ("recording: mss takes the model alone", {"format": "mss", "recording": self.other}),
            (r"draws: 0 is outside \[1, 100000\]", {"format": "mss", "draws": 0}),
            (r"horizon: 601.0* is outside \[0, 600\]", {"format": "csv", "recording": self.other, "horizon": 601}),
            ("vehicle: mss needs one", {"format": "mss", "vehicle": None}),
        ):
            with self.subTest(says), self.assertRaisesRegex(telltale.InputError, says):
                telltale.export(self.model, self.folder / "none", **{"vehicle": twin.BOAT, **arguments})
        with self.assertRaisesRegex(telltale.DataCannotTell, "mass"):
            telltale.export(self.model, self.folder / "none", "vrx", telltale.Vehicle("yellowfish", propeller_separation_m=0.7))


class DiagnoseTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        cls.model = telltale.identify(telltale.load(twin.SAMPLE, vehicle=twin.BOAT), **FAST)
        cls.model_file = cls.folder / "model.json"
        cls.model.save(cls.model_file)
        cls.today_log = twin.record(cls.folder / "today", duration=200, seed=5, port_strength=0.6)
        cls.monday_log = twin.record(cls.folder / "monday", duration=200, seed=3)
        cls.today = telltale.load(cls.today_log, vehicle=twin.BOAT)
        cls.monday = telltale.load(cls.monday_log, vehicle=twin.BOAT)

    def test_a_diagnosis_is_that_of_the_command_and_names_the_weak_thruster(self):
        diagnosis = telltale.diagnose(self.model, self.today, [self.monday])
        said = twin.answer("diagnose", "--model", self.model_file, "--log", self.today_log, "--reference-log", self.monday_log, "--vehicle", twin.BOAT)
        self.assertEqual(diagnosis.to_dict(), said)
        self.assertEqual(diagnosis.verdict, said["verdict"])
        self.assertEqual(diagnosis.causes[0].effects, ["thruster_imbalance"])
        self.assertIn("ort thruster", diagnosis.sentence)
        (part,) = diagnosis.causes[0].parts
        self.assertEqual(part.effect, "thruster_imbalance")
        self.assertEqual([part.sentence], diagnosis.causes[0].sentences)
        estimates = [{"name": of.name, "estimate": of.estimate, "standardError": of.standard_error, "unit": of.unit, "effect": part.effect} for of in part.parameters]
        self.assertEqual(estimates, said["causes"][0]["parameters"])
        self.assertIsNone(part.direction)
        self.assertEqual(diagnosis.present_weather, [])
        page = diagnosis.to_html()
        self.assertTrue(page.lower().startswith("<!doctype html>"))
        self.assertRegex(page, r"Recording</th><td>today</td>.*References</th><td>monday</td>")
        self.assertGreater(diagnosis.gap, 1.0)
        better = telltale.validate(diagnosis.model, self.today, horizons=[5]).free_run[0]
        worse = telltale.validate(self.model, self.today, horizons=[5]).free_run[0]
        self.assertLess(better.position_rmse_m, worse.position_rmse_m)

    def test_weather_has_a_size_and_a_direction(self):
        log = twin.record(self.folder / "adrift", duration=200, seed=6)
        twin.set_adrift(log, north=0.3)
        diagnosis = telltale.diagnose(self.model, telltale.load(log, vehicle=twin.BOAT), [self.monday])
        self.assertEqual(diagnosis.present_weather, ["current"])
        (current,) = diagnosis.causes[0].parts
        self.assertEqual(current.size.name, "speed")
        self.assertAlmostEqual(current.size.estimate, 0.3, delta=3 * current.size.standard_error)
        off = (current.direction.towards_deg + 180) % 360 - 180
        self.assertLess(abs(off), 1.6 * current.direction.half_width_deg)
        self.assertLess(current.direction.half_width_deg, 90)
        self.assertIn("deg", repr(current.direction))

    def test_references_that_are_no_evidence_of_their_own_are_refused(self):
        sample = telltale.load(twin.SAMPLE, vehicle=twin.BOAT)
        for references, says in (
            ([self.today], "is both the recording to diagnose and a reference"),
            ([sample], "made the model"),
            ([self.monday, self.monday], "holds the same recording as"),
        ):
            with self.subTest(says), self.assertRaises(telltale.DataCannotTell) as raised:
                telltale.diagnose(self.model, self.today, references)
            self.assertIn(says, raised.exception.reason)

    def test_an_effect_that_there_is_not_is_named(self):
        with self.assertRaisesRegex(telltale.InputError, "^without: no such effect as nonsense; there are "):
            telltale.diagnose(self.model, self.today, without=["nonsense"])

    def test_a_model_of_another_boat_is_refused(self):
        stranger = telltale.load(self.today_log, vehicle=telltale.Vehicle("stranger", propeller_separation_m=0.7))
        with self.assertRaises(telltale.DataCannotTell) as raised:
            telltale.diagnose(self.model, stranger)
        self.assertIn("stranger", raised.exception.reason)


if __name__ == "__main__":
    unittest.main()
