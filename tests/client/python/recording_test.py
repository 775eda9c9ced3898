"""Recordings go in and out as arrays, and what cannot be trusted is said."""

import json
import pathlib
import tempfile
import unittest

import numpy as np
import telltale
import twin


def arrays_of(recording):
    """What from_arrays takes."""
    names = ("fix_time_s", "latitude_deg", "longitude_deg", "heading_time_s", "heading_deg", "command_time_s", "port_us", "starboard_us")
    return {name: getattr(recording, name) for name in names}


class RecordingTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.log = pathlib.Path(twin.record(pathlib.Path(cls.folder.name) / "run", duration=120))
        cls.recording = telltale.load(cls.log, vehicle=twin.BOAT)

    def test_arrays_are_the_columns_of_the_files(self):
        columns = {
            "gnss": ("fix_time_s", "latitude_deg", "longitude_deg"),
            "heading": ("heading_time_s", "heading_deg"),
            "thrusters": ("command_time_s", "port_us", "starboard_us"),
        }
        for file, names in columns.items():
            table = np.loadtxt(self.log / f"{file}.csv", delimiter=",", skiprows=1)
            for column, name in enumerate(names):
                np.testing.assert_array_equal(getattr(self.recording, name), table[:, column], err_msg=name)

    def test_positions_are_metres_from_the_first_fix(self):
        # Radii of curvature of WGS84; Moritz, Geodetic Reference System 1980.
        first = np.radians(self.recording.latitude_deg[0])
        a, e2 = 6378137.0, 0.00669437999014
        w = np.sqrt(1 - e2 * np.sin(first) ** 2)
        meridian, parallel = a * (1 - e2) / w**3, a / w * np.cos(first)
        north = meridian * np.radians(self.recording.latitude_deg - self.recording.latitude_deg[0])
        east = parallel * np.radians(self.recording.longitude_deg - self.recording.longitude_deg[0])
        self.assertGreater(np.ptp(self.recording.north_m), 10)
        np.testing.assert_allclose(self.recording.north_m, north, atol=0.01)
        np.testing.assert_allclose(self.recording.east_m, east, atol=0.01)

    def test_commands_are_shares_of_full_command(self):
        # The boat's file says 1500 us for neutral and 400 us to full command, either way.
        expected = np.column_stack([self.recording.port_us, self.recording.starboard_us]) / 400 - 3.75
        np.testing.assert_allclose(self.recording.commands, expected, atol=1e-12)

    def test_a_recording_of_its_own_arrays_is_the_same(self):
        again = telltale.Recording.from_arrays(vehicle=twin.BOAT, name="again", **arrays_of(self.recording))
        self.assertEqual(again.name, "again")
        for name, values in arrays_of(self.recording).items():
            np.testing.assert_array_equal(getattr(again, name), values, err_msg=name)

    def test_arrays_take_what_numpy_takes(self):
        lists = {name: values.tolist() for name, values in arrays_of(self.recording).items()}
        lists["port_us"] = np.asarray(lists["port_us"], dtype=np.float32)
        again = telltale.Recording.from_arrays(vehicle=self.recording.vehicle, **lists)
        np.testing.assert_array_equal(again.port_us, self.recording.port_us)

    def test_changing_an_array_leaves_the_recording(self):
        self.recording.fix_time_s[:] = -1.0
        self.assertGreaterEqual(self.recording.fix_time_s.min(), 0.0)

    def test_a_saved_recording_is_read_back(self):
        folder = pathlib.Path(self.folder.name) / "saved"
        self.recording.save(folder)
        again = telltale.load(folder, vehicle=twin.BOAT)
        np.testing.assert_array_equal(again.port_us, self.recording.port_us)
        np.testing.assert_allclose(again.latitude_deg, self.recording.latitude_deg, rtol=0, atol=1e-9)

    def test_samples_that_cannot_be_trusted_are_counted(self):
        arrays = arrays_of(self.recording)
        arrays["latitude_deg"][7] = np.nan
        arrays["heading_deg"][9] = 1e6
        again = telltale.Recording.from_arrays(vehicle=twin.BOAT, **arrays)
        self.assertEqual(sum(again.rejected.values()), 2)
        self.assertEqual(len(again.fix_time_s), len(self.recording.fix_time_s) - 1)

    def test_arrays_that_do_not_fit_are_named(self):
        for name, wrong, says in (
            ("heading_deg", [1.0, 2.0], "heading_deg: 2 values, but"),
            ("port_us", np.zeros((3, 2)), "port_us: give an array of one dimension, not of 2"),
        ):
            with self.subTest(name), self.assertRaisesRegex(telltale.InputError, says):
                telltale.Recording.from_arrays(vehicle=twin.BOAT, **{**arrays_of(self.recording), name: wrong})

    def test_a_channel_without_samples_is_refused(self):
        arrays = {**arrays_of(self.recording), "heading_time_s": [], "heading_deg": []}
        with self.assertRaises(telltale.DataCannotTell) as raised:
            telltale.Recording.from_arrays(vehicle=twin.BOAT, **arrays)
        self.assertIn("heading", raised.exception.subject + raised.exception.reason)

    def test_what_is_not_there_is_not_found(self):
        for call in (telltale.load, telltale.load_model, telltale.load_vehicle):
            with self.subTest(call.__name__), self.assertRaises(FileNotFoundError) as raised:
                call("no/such/path")
            self.assertEqual(raised.exception.filename, "no/such/path")
        with self.assertRaises(FileNotFoundError):
            telltale.load(self.log, vehicle="no/such/path")

    def test_arguments_out_of_range_are_named_with_their_range(self):
        with self.assertRaisesRegex(telltale.InputError, r"gps_instance.*255"):
            telltale.load(self.log, vehicle=twin.BOAT, gps_instance=300)
        with self.assertRaisesRegex(telltale.InputError, "output 3 stands for both thrusters"):
            telltale.load(self.log, vehicle=twin.BOAT, port_channel=3, starboard_channel=3)
        with self.assertRaisesRegex(telltale.InputError, r"propeller_separation_m"):
            telltale.Vehicle("boat", propeller_separation_m=-1.0)

    def test_a_vehicle_is_what_its_file_says(self):
        vehicle = telltale.load_vehicle(twin.BOAT)
        self.assertEqual(vehicle.vehicle_id, "yellowfish")
        self.assertEqual((vehicle.port.neutral_us, vehicle.port.full_forward_us, vehicle.port.full_reverse_us), (1500, 1900, 1100))
        self.assertEqual(vehicle.gnss_antenna_m, (-0.3, 0.0))
        same = telltale.Vehicle("yellowfish", propeller_separation_m=0.7, gnss_antenna_m=(-0.3, 0.0), mass_kg=vehicle.mass_kg)
        self.assertEqual(str(same), str(vehicle))

    def test_a_file_that_is_no_vehicle_is_an_input_error_in_the_words_of_the_command(self):
        wrong = pathlib.Path(self.folder.name) / "wrong.textproto"
        wrong.write_text('vehicle_id: "boat"\npropeller_separation_m: -3\n')
        with self.assertRaises(telltale.InputError) as raised:
            telltale.load_vehicle(wrong)
        said = twin.telltale("identify", "--log", self.log, "--vehicle", wrong)
        self.assertEqual(said.returncode, 1)
        self.assertIn(twin.words(str(raised.exception)), twin.words(said.stderr))


class CheckTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.sample = telltale.load(twin.SAMPLE, vehicle=twin.BOAT)

    def test_the_sample_shows_no_fault(self):
        checked = telltale.check(self.sample)
        self.assertEqual(checked.findings, [])
        self.assertIsNone(checked.delays_unknown)

    def test_a_check_is_the_one_of_the_command(self):
        checked = telltale.check(self.sample)
        said = twin.answer("check", "--log", twin.SAMPLE, "--vehicle", twin.BOAT)
        self.assertEqual(json.loads(checked.to_json()), said)
        self.assertEqual(checked.to_dict(), said["logs"][0])
        delays = checked.to_dict()["delays"]
        self.assertEqual((checked.delays.start_s, checked.delays.end_s), (delays["startS"], delays["endS"]))
        for name in ("commands", "fixes"):
            delay = getattr(checked.delays, name)
            with self.subTest(name):
                self.assertEqual((delay.name, delay.equation), (f"delay_{name}", ""))
                self.assertEqual(delay.estimate, delays[name]["estimate"])
                self.assertEqual((delay.lower, delay.upper), (delays[name]["interval"]["lower"], delays[name]["interval"]["upper"]))

    def test_late_fixes_are_within_the_bounds_of_their_delay(self):
        arrays = arrays_of(self.sample)
        arrays["fix_time_s"] += 0.4
        late = telltale.check(telltale.Recording.from_arrays(vehicle=twin.BOAT, **arrays)).delays.fixes
        as_recorded = telltale.check(self.sample).delays.fixes
        self.assertLess(as_recorded.upper, 0.4)
        self.assertTrue(late.lower < 0.4 < late.upper, late)

    def test_a_check_without_a_vehicle_says_why_delays_are_unknown(self):
        checked = telltale.check(telltale.load(twin.SAMPLE))
        self.assertIsNone(checked.delays)
        self.assertIn("vehicle", checked.delays_unknown.advice)
        self.assertEqual(checked.to_dict()["delays"]["unknown"]["reason"], checked.delays_unknown.reason)

    def test_what_progress_raises_ends_a_check(self):
        def stop(stage, done):
            raise StopIteration(stage)

        with self.assertRaises(StopIteration):
            telltale.check(self.sample, progress=stop)

    def test_swapped_thrusters_are_found_in_the_words_of_the_command(self):
        arrays = arrays_of(self.sample)
        arrays["port_us"], arrays["starboard_us"] = arrays["starboard_us"], arrays["port_us"]
        swapped = telltale.Recording.from_arrays(vehicle=twin.BOAT, name="swapped", **arrays)
        checked = telltale.check(swapped)
        findings = checked.findings
        self.assertTrue(findings)
        self.assertIn("fault of input", checked.delays_unknown.reason)
        with tempfile.TemporaryDirectory() as folder:
            swapped.save(folder)
            said = twin.telltale("check", "--log", folder, "--vehicle", twin.BOAT)
        self.assertEqual(said.returncode, 3)
        for part in (findings[0].subject, findings[0].reason, findings[0].advice):
            self.assertIn(" ".join(part.split()), " ".join(said.stdout.split()))
        with self.assertRaises(telltale.DataCannotTell) as raised:
            telltale.identify(swapped)
        self.assertIn(findings[0].reason, raised.exception.reason)
        self.assertIn("skip_input_check", raised.exception.advice)


if __name__ == "__main__":
    unittest.main()
