"""A real telltaled with a web server, for the tests of tests/web and tests/prometheus."""
import contextlib
import http.client
import json
import os
import pathlib
import re
import subprocess
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILT = pathlib.Path(os.environ.get("TELLTALE_BUILT", ROOT / "build/release"))
SAMPLE = ROOT / "deploy/sample"
TOKEN = "a-token-of-the-tests"
BOAT = "yellowfish"


def until(condition, what, seconds=240):
    """Asks until the condition holds, and gives back what it answers."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        with contextlib.suppress(OSError):
            answer = condition()
            if answer:
                return answer
        time.sleep(0.1)
    raise AssertionError(f"not within {seconds} s: {what}")


class Daemon:
    """Serves deploy/sample's boat and `more` others `named` so, on a free port and a domain of its own."""

    def __init__(self, token=True, more=0, connections=32, port=0, folder=None, http="",
                 named="boat-{:04}"):
        self._temporary = None if folder else tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(folder or self._temporary.name)
        self.environment = dict(os.environ, TELLTALE_DDS_TAG=f"web-{os.getpid()}",
                                CYCLONEDDS_URI=f"file://{ROOT}/deploy/cyclonedds/loopback.xml")
        (self.folder / "models").mkdir(exist_ok=True)
        (self.folder / "token").write_text(TOKEN + "\n")
        vehicle = (SAMPLE / f"{BOAT}.textproto").read_text()
        names = []
        for number in range(more):
            name = self.folder / f"{named.format(number)}.textproto"
            name.write_text(vehicle.replace(f'"{BOAT}"', f'"{name.stem}"'))
            names.append(f'vehicle_files: "{name}"\n')
        self.config = self.folder / "telltaled.textproto"
        self.config.write_text(
            f'domain: 78\nvehicle_files: "{SAMPLE / BOAT}.textproto"\n{"".join(names)}'
            f'state_directory: "{self.folder}/models"\n'
            "identification { bootstrap_replicates: 100 structure: \"static\" }\n"
            f'http {{ port: {port} connections: {connections}'
            f'{" token_file: " + chr(34) + "token" + chr(34) if token else ""} {http} }}\n')
        self.process = None
        try:
            self.start()
        except AssertionError:
            self.__exit__()
            raise

    def start(self):
        with open(self.folder / "telltaled.log", "w") as log:
            self.process = subprocess.Popen([BUILT / "service/telltaled", "--config", self.config],
                                            stderr=log, env=self.environment)
        address = until(self._address, "the daemon says where its page is")
        self.address, self.port = address[0].rstrip("/"), int(address[1])

    def _address(self):
        if self.process.poll() is not None:
            raise AssertionError("telltaled ended: " + (self.folder / "telltaled.log").read_text())
        found = re.search(r"the page is at (https?://127\.0\.0\.1:(\d+)/)",
                          (self.folder / "telltaled.log").read_text())
        return found and found.groups()

    def stop(self):
        self.process.terminate()
        code = self.process.wait(timeout=60)
        assert code == 0, f"telltaled exits {code}: " + (self.folder / "telltaled.log").read_text()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
        if self._temporary:
            self._temporary.cleanup()

    def telltale(self, *arguments):
        done = subprocess.run([BUILT / "client/telltale", *map(str, arguments), "--domain", "78"],
                              env=self.environment, capture_output=True, text=True, timeout=300)
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout

    def compare(self, earlier, later):
        """What `telltale compare` prints of two files."""
        return subprocess.run([BUILT / "client/telltale", "compare", "--model", earlier, "--model", later],
                              check=True, capture_output=True, text=True, timeout=60).stdout

    def exported(self, model, format):
        """What `telltale export` writes of a file."""
        folder = self.folder / "exported"
        folder.mkdir(exist_ok=True)
        subprocess.run([BUILT / "client/telltale", "export", "--model", model, "--vehicle", SAMPLE / f"{BOAT}.textproto",
                        "--format", format, "--out", folder], check=True, capture_output=True, timeout=60)
        return (folder / {"mss": "mss.json", "vrx": "vrx.sdf"}[format]).read_text()

    def replay(self, boat=BOAT, first_s=0, last_s=600, speed=100):
        """The sample from its second first_s to last_s."""
        with self.replaying(boat, first_s, last_s, speed) as replay:
            assert replay.wait(timeout=300) == 0

    @contextlib.contextmanager
    def replaying(self, boat=BOAT, first_s=0, last_s=600, speed=1):
        """The same, until the block ends."""
        with tempfile.TemporaryDirectory() as folder:
            for name in ("gnss.csv", "heading.csv", "thrusters.csv"):
                head, *rows = (SAMPLE / name).read_text().splitlines()
                part = [row for row in rows if first_s <= float(row.split(",")[0]) <= last_s]
                (pathlib.Path(folder) / name).write_text("\n".join([head, *part]) + "\n")
            replay = subprocess.Popen(
                [BUILT / "client/telltale", "replay", "--vehicle-id", boat, "--log", folder, "--speed",
                 str(speed), "--domain", "78"], env=self.environment, stdout=subprocess.DEVNULL)
            try:
                yield replay
            finally:
                replay.terminate()
                replay.wait(timeout=60)

    @contextlib.contextmanager
    def loading(self, boats):
        """Sparse telemetry of load-00001 and so many more, until the block ends."""
        load = subprocess.Popen([BUILT / "client/telltale", "load", "--boats", str(boats), "--times", "0.1",
                                 "--duration", "3600", "--domain", "78"],
                                env=self.environment, stdout=subprocess.DEVNULL)
        try:
            yield load
        finally:
            load.terminate()
            load.wait(timeout=60)

    def ask(self, method, route, body=None, headers=None):
        """Status, headers and text of one request."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=30)
        try:
            connection.request(method, route, body, headers or {})
            answer = connection.getresponse()
            return answer.status, answer.headers, answer.read().decode()
        finally:
            connection.close()

    def get(self, route):
        status, _, text = self.ask("GET", route)
        assert status == 200, f"{route}: {status} {text}"
        return json.loads(text)

    def order(self, kind, boat=BOAT, token=TOKEN, body=None, content="application/json", **more):
        headers = {"Content-Type": content}
        if token:
            headers["Authorization"] = f"Bearer {token}"
        text = json.dumps({"vehicleId": boat, **more}) if body is None else body
        status, answered, answer = self.ask("POST", f"/api/v1/{kind}", text, headers)
        return status, answered, json.loads(answer)
