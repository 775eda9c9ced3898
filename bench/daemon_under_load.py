"""A daemon of the build and the boats of `telltale load`, on this machine. TELLTALE_BUILT names the build folder."""
import argparse
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


def load_command(boats, domain=DOMAIN):
    return [BUILT / "client/telltale", "load", "--domain", domain, "--boats", str(boats)]


def write_vehicles(folder, boats):
    """Vehicle files of the boats of `telltale load`; returns the line of a configuration that names them."""
    subprocess.run([*load_command(boats), "--write-vehicles", folder / "boats"], check=True, stdout=subprocess.DEVNULL)
    return f'vehicle_folder: "{folder}/boats"\n'


def start(stack, command, **streams):
    """A process that ends with the stack."""
    process = stack.enter_context(subprocess.Popen(command, env=loopback_environment(), **streams))
    stack.callback(process.terminate)
    return process


def given_arguments(documentation, **defaults):
    """Of the command line: an option for each default, of its type."""
    arguments = argparse.ArgumentParser(description=documentation, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name, default in defaults.items():
        arguments.add_argument(f"--{name.replace('_', '-')}", type=type(default), default=default)
    return arguments.parse_args()


def processor_s(pid):
    """Processor time of a process, all threads."""
    fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / TICKS


class Daemon:
    """telltaled, which ends with the stack. `settings`: lines of its configuration. `name`: of its files in the folder."""

    def __init__(self, stack, folder, settings, name="telltaled", connections=128, domain=DOMAIN):
        self.log_file = folder / f"{name}.log"
        self.state = folder / name
        config = folder / f"{name}.textproto"
        config.write_text(f'domain: {domain}\nstate_directory: "{self.state}"\n'
                          f"http {{ port: 0 connections: {connections} }}\n{settings}")
        with open(self.log_file, "w") as log:
            self.daemon = start(stack, [BUILT / "service/telltaled", "--config", config], stderr=log)
        self.port = self._await_port()

    def _await_port(self):
        while True:
            found = re.search(r"page is at http://127\.0\.0\.1:(\d+)/", self.log())
            if found:
                return int(found.group(1))
            assert self.daemon.poll() is None, self.log()
            time.sleep(0.1)

    def log(self):
        return self.log_file.read_text()

    def cpu_s(self):
        return processor_s(self.daemon.pid)

    def open_descriptors(self):
        return len(list(pathlib.Path(f"/proc/{self.daemon.pid}/fd").iterdir()))

    def stored_bytes(self):
        """What the state directory takes on disk."""
        return sum(file.stat().st_blocks * 512 for file in self.state.rglob("*") if file.is_file())

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

    def totals(self, *names):
        """Of metrics of every boat or channel, at one time."""
        text = self.get("/metrics").decode()
        return [sum(map(float, re.findall(rf"^{name}\S* (\S+)$", text, re.M))) for name in names]

    def total(self, name):
        return self.totals(name)[0]

    def await_telemetry(self):
        while self.total("telltale_received_samples_total") == 0:
            time.sleep(1)

    def cores(self, seconds):
        """Cores that the daemon takes, on average over so many seconds."""
        before, begun = self.cpu_s(), time.monotonic()
        time.sleep(seconds)
        return (self.cpu_s() - before) / (time.monotonic() - begun)


class Fleet(Daemon):
    """A daemon and the load of its boats, until the block ends. `load_options`: more of `telltale load`."""

    def __init__(self, boats, connections=128, settings="", load_options=()):
        self._stack = contextlib.ExitStack()
        folder = pathlib.Path(self._stack.enter_context(tempfile.TemporaryDirectory()))
        super().__init__(self._stack, folder, write_vehicles(folder, boats) + settings, connections=connections)
        self.load = start(self._stack, [*load_command(boats), *load_options, "--duration", "86400"],
                          stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def __enter__(self):
        return self

    def __exit__(self, *fault):
        self._stack.__exit__(*fault)

    def identify_in_turn(self, boats, end):
        """Identifies one boat after another until `end` of the monotonic clock: of each the exit code of the command and
        the seconds that it took."""
        done = []
        while (begun := time.monotonic()) < end:
            answer = self.telltale("identify", "--vehicle-id", f"load-{1 + len(done) % boats:05}")
            done.append((answer.returncode, time.monotonic() - begun))
        return done

    def begin(self, *arguments):
        """The command on the daemon's domain. It ends with the block at the latest."""
        return start(self._stack, [BUILT / "client/telltale", *arguments, "--domain", DOMAIN],
                     stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def telltale(self, *arguments, **options):
        """The command on the daemon's domain, to its end."""
        return subprocess.run([BUILT / "client/telltale", *arguments, "--domain", DOMAIN], env=loopback_environment(),
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **options)
