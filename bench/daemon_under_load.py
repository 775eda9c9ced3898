"""A daemon of the build and the boats of `telltale load`, on this machine. TELLTALE_BUILT names the build folder."""
import contextlib
import http.client
import os
import pathlib
import re
import subprocess
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[1]
BUILT = pathlib.Path(os.environ.get("TELLTALE_BUILT", ROOT / "build/release"))
DOMAIN = "79"
TICKS = os.sysconf("SC_CLK_TCK")
PAGE_BYTES = os.sysconf("SC_PAGE_SIZE")


def loopback_environment():
    return dict(os.environ, TELLTALE_DDS_TAG=f"cost-{os.getpid()}",
                CYCLONEDDS_URI=f"file://{ROOT}/deploy/cyclonedds/loopback.xml")


def load_command(boats):
    return [BUILT / "client/telltale", "load", "--domain", DOMAIN, "--boats", str(boats)]


class Fleet:
    """A daemon and the load of its boats, until the block ends. `load_options`: more of `telltale load`."""

    def __init__(self, boats, connections=128, settings="", load_options=()):
        self._stack = contextlib.ExitStack()
        self.folder = pathlib.Path(self._stack.enter_context(tempfile.TemporaryDirectory()))
        self.environment = loopback_environment()
        load = load_command(boats)
        subprocess.run([*load, "--write-vehicles", self.folder / "boats"], check=True, stdout=subprocess.DEVNULL)
        config = self.folder / "telltaled.textproto"
        config.write_text(f'domain: {DOMAIN}\nvehicle_folder: "{self.folder}/boats"\n'
                          f'state_directory: "{self.folder}/state"\n'
                          f"http {{ port: 0 connections: {connections} }}\n{settings}")
        with open(self.folder / "log", "w") as log:
            self.daemon = self._start([BUILT / "service/telltaled", "--config", config], stderr=log)
        self.port = self._await_port()
        self.load = self._start([*load, *load_options, "--duration", "86400"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def _start(self, command, **streams):
        process = self._stack.enter_context(subprocess.Popen(command, env=self.environment, **streams))
        self._stack.callback(process.terminate)
        return process

    def _await_port(self):
        while True:
            found = re.search(r"page is at http://127\.0\.0\.1:(\d+)/", (self.folder / "log").read_text())
            if found:
                return int(found.group(1))
            assert self.daemon.poll() is None, (self.folder / "log").read_text()
            time.sleep(0.1)

    def __enter__(self):
        return self

    def __exit__(self, *fault):
        self._stack.__exit__(*fault)

    def cpu_s(self):
        """Processor time of the daemon, all threads."""
        fields = pathlib.Path(f"/proc/{self.daemon.pid}/stat").read_text().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / TICKS

    def begin(self, *arguments):
        """The command on the daemon's domain. It ends with the block at the latest."""
        return self._start([BUILT / "client/telltale", *arguments, "--domain", DOMAIN], stdout=subprocess.DEVNULL,
                           stderr=subprocess.DEVNULL)

    def telltale(self, *arguments, **options):
        """The command on the daemon's domain, to its end."""
        return subprocess.run([BUILT / "client/telltale", *arguments, "--domain", DOMAIN], env=self.environment,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **options)

    def open_descriptors(self):
        return len(list(pathlib.Path(f"/proc/{self.daemon.pid}/fd").iterdir()))

    def stored_bytes(self):
        """What the state directory takes on disk."""
        return sum(file.stat().st_blocks * 512 for file in (self.folder / "state").rglob("*") if file.is_file())

    def resident_bytes(self):
        return int(pathlib.Path(f"/proc/{self.daemon.pid}/statm").read_text().split()[1]) * PAGE_BYTES

    def dropped_packets(self):
        """Those that found the receive buffers of the daemon full."""
        sockets = set()
        for descriptor in pathlib.Path(f"/proc/{self.daemon.pid}/fd").iterdir():
            with contextlib.suppress(FileNotFoundError):  # it has been closed in the meantime
                sockets.update(re.findall(r"^socket:\[(\d+)\]", os.readlink(descriptor)))
        rows = [row.split() for row in pathlib.Path("/proc/net/udp").read_text().splitlines()[1:]]
        return sum(int(row[12]) for row in rows if row[9] in sockets)

    def get(self, route):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=60)
        connection.request("GET", route)
        answer = connection.getresponse()
        text = answer.read()
        assert answer.status == 200, (route, answer.status)
        connection.close()
        return text

    def total(self, name):
        """Of a metric of every boat or channel."""
        return sum(map(float, re.findall(rf"^{name}\S* (\S+)$", self.get("/metrics").decode(), re.M)))

    def await_telemetry(self):
        while self.total("telltale_received_samples_total") == 0:
            time.sleep(1)

    def cores(self, seconds):
        """Cores that the daemon takes, on average over so many seconds."""
        before, begun = self.cpu_s(), time.monotonic()
        time.sleep(seconds)
        return (self.cpu_s() - before) / (time.monotonic() - begun)
