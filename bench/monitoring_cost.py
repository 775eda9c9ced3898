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
import pathlib
import shutil
import socket
import subprocess
import threading
import time

from daemon_under_load import ROOT, Fleet

SCRAPES = 20
SPARE_CONNECTIONS = 60


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
    with Fleet(given.boats, 2 * given.pages + SPARE_CONNECTIONS) as fleet:
        fleet.await_telemetry()
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
