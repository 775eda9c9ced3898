"""A wheel of the tree installs into a fresh environment, without a network, and works there."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import twin


class WheelTest(unittest.TestCase):
    def test_a_wheel_installs_and_identifies(self):
        offline = ("--no-index", "--no-deps", "--disable-pip-version-check", "--quiet")
        environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}

        def run(*command):
            done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            return done.stdout

        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            run(sys.executable, "-m", "pip", "wheel", *offline, "--no-build-isolation", "-w", folder, twin.ROOT / "client/python")
            (wheel,) = folder.glob("telltale-*-linux_*.whl")
            fresh = folder / "fresh"
            run(sys.executable, "-m", "venv", "--system-site-packages", fresh)  # for NumPy
            run(fresh / "bin/pip", "install", *offline, wheel)
            said = run(
                fresh / "bin/python", "-c",
                "import sys, telltale\n"
                "recording = telltale.load(sys.argv[1], vehicle=sys.argv[2])\n"
                "print(telltale.__file__)\n"
                "print(telltale.identify(recording, estimator='one-step', bootstrap=0))",
                twin.SAMPLE, twin.BOAT,
            ).splitlines()
            self.assertTrue(said[0].startswith(str(fresh)), said[0])
            self.assertIn("yellowfish", said[1])


if __name__ == "__main__":
    unittest.main()
