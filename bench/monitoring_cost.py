#!/usr/bin/env python3
"""What watching a fleet costs the daemon, and how fast its page is: docs/validation/monitoring.md.

  monitoring_cost.py [--boats N] [--pages N] [--seconds S] [--browser MODULES]

Starts telltaled and `telltale load` on this machine, and measures the processor time of telltaled in /proc: alone,
while /metrics is scraped, and while open pages follow the events. --browser names a folder with the packages of
tests/web/package.json (build/release/tests/page after a run of its test), and also times the page in Chromium.
TELLTALE_BUILT names the build folder.
"""
import argparse
import contextlib
import http.client
import os
import pathlib
import re
import shutil
import socket
import subprocess
import tempfile
import threading
import time

ROOT = pathlib.Path(__file__).resolve().parents[1]
BUILT = pathlib.Path(os.environ.get("TELLTALE_BUILT", ROOT / "build/release"))
DOMAIN = "79"
TICKS = os.sysconf("SC_CLK_TCK")
SCRAPES = 20
SPARE_CONNECTIONS = 60


class Fleet:
    """A daemon and the load of its boats, until the block ends."""

    def __init__(self, boats, pages):
        self._stack = contextlib.ExitStack()
        self.folder = pathlib.Path(self._stack.enter_context(tempfile.TemporaryDirectory()))
        self.environment = dict(os.environ, TELLTALE_DDS_TAG=f"cost-{os.getpid()}",
                                CYCLONEDDS_URI=f"file://{ROOT}/deploy/cyclonedds/loopback.xml")
        load = [BUILT / "client/telltale", "load", "--domain", DOMAIN, "--boats", str(boats)]
        subprocess.run([*load, "--write-vehicles", self.folder / "boats"], check=True, stdout=subprocess.DEVNULL)
        config = self.folder / "telltaled.textproto"
        config.write_text(f'domain: {DOMAIN}\nvehicle_folder: "{self.folder}/boats"\n'
                          f'state_directory: "{self.folder}/state"\n'
                          f"http {{ port: 0 connections: {2 * pages + SPARE_CONNECTIONS} }}\n")
        with open(self.folder / "log", "w") as log:
            self.daemon = self._start([BUILT / "service/telltaled", "--config", config], stderr=log)
        self.port = self._await_port()
        self.load = self._start([*load, "--duration", "86400"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

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

    def get(self, route):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=60)
        connection.request("GET", route)
        answer = connection.getresponse()
        text = answer.read()
        assert answer.status == 200, (route, answer.status)
        connection.close()
        return text

    def gauge(self, name):
        return float(re.search(rf"^{name}\S* (\S+)$", self.get("/metrics").decode(), re.M).group(1))

    def cores(self, seconds):
        """Cores that the daemon takes, on average over so many seconds."""
        before, begun = self.cpu_s(), time.monotonic()
        time.sleep(seconds)
        return (self.cpu_s() - before) / (time.monotonic() - begun)


class Pages:
    """Open pages, as far as the daemon sees of them: each follows the events and reads what comes."""

    def __init__(self, port, count):
        self.streams = []
        self.received = 0
        for _ in range(count):
            stream = socket.create_connection(("127.0.0.1", port))
            stream.sendall(b"GET /api/v1/events HTTP/1.1\r\nHost: bench\r\n\r\n")
            self.streams.append(stream)
        self.readers = [threading.Thread(target=self._read, args=(stream,), daemon=True) for stream in self.streams]
        for reader in self.readers:
            reader.start()

    def _read(self, stream):
        with contextlib.suppress(OSError):
            while block := stream.recv(1 << 20):
                self.received += len(block)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for stream in self.streams:
            stream.shutdown(socket.SHUT_RDWR)
        for reader in self.readers:
            reader.join()


def scrape_cost(fleet, cores_alone):
    """Seconds of processor time, size and duration of a scrape."""
    before, begun = fleet.cpu_s(), time.monotonic()
    sizes = [len(fleet.get("/metrics")) for _ in range(SCRAPES)]
    took = time.monotonic() - begun
    cpu_s = fleet.cpu_s() - before - cores_alone * took
    return cpu_s / SCRAPES, max(sizes), took / SCRAPES


def time_the_page(fleet, modules, seconds):
    browser = shutil.which("chromium")
    assert browser, "no chromium"
    shutil.copy(ROOT / "bench/page_speed.mjs", modules)
    subprocess.run(["node", "page_speed.mjs", f"http://127.0.0.1:{fleet.port}", str(seconds), browser],
                   cwd=modules, check=True)


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--boats", type=int, default=1000)
    arguments.add_argument("--pages", type=int, default=100)
    arguments.add_argument("--seconds", type=float, default=30)
    arguments.add_argument("--browser", type=pathlib.Path, metavar="MODULES")
    given = arguments.parse_args()
    with Fleet(given.boats, given.pages) as fleet:
        while fleet.gauge("telltale_received_samples_total") == 0:
            time.sleep(1)
        time.sleep(given.seconds)  # until the windows hold what a minute's evaluation asks for
        alone = fleet.cores(given.seconds)
        print(f"{given.boats} boats, {given.seconds:.0f} s each\nalone: {alone:.3f} cores")
        cpu_s, size, took = scrape_cost(fleet, alone)
        print(f"a scrape: {1e3 * cpu_s:.1f} ms of processor time, {size / 1e6:.2f} MB, answered in {1e3 * took:.0f} ms;"
              f" one each 15 s: {cpu_s / 15 / alone:.2%} of the daemon's processor time")
        with Pages(fleet.port, given.pages) as pages:
            time.sleep(2)
            received = pages.received
            watched = fleet.cores(given.seconds)
            rate = (pages.received - received) / given.seconds
        print(f"{given.pages} pages: {watched - alone:.3f} cores more, {(watched - alone) / watched:.1%} of the"
              f" daemon's processor time; {rate / 1e6:.1f} MB/s to all of them")
        if given.browser:
            time_the_page(fleet, given.browser, given.seconds)


main()
