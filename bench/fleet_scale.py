#!/usr/bin/env python3
"""What a large fleet takes of several daemons on this machine: docs/guides/scale.md.

  fleet_scale.py [--boats N] [--domains N] [--daemons N] [--times X] [--lease S] [--seconds S]

The boats are divided evenly among DDS domains, which hold at most 5000 each. The daemons of a domain share its boats by
slices, by leases of so many seconds in a database of one PostgreSQL server that the script starts. `telltale load` sends X
times the 65 samples a second of each boat. Prints processor time and memory of daemons and server, the same a boat, and
what was lost. TELLTALE_BUILT names the build folder.
"""
import contextlib
import os
import pathlib
import pwd
import re
import subprocess
import tempfile
import time

from daemon_under_load import DOMAIN, Daemon, given_arguments, load_command, processor_s, start, write_vehicles


class PostgresServer:
    """A server of its own, which ends with the stack."""

    def __init__(self, stack, folder):
        self.folder = folder / "postgres"
        self.folder.mkdir()
        self._programs = sorted(pathlib.Path("/usr/lib/postgresql").glob("*/bin/postgres"))[-1].parent
        self._as_user = []
        if os.geteuid() == 0:  # it refuses to run as root
            user = pwd.getpwnam("postgres")
            os.chown(self.folder, user.pw_uid, user.pw_gid)
            folder.chmod(0o755)
            self._as_user = ["setpriv", "--reuid", "postgres", "--regid", "postgres", "--clear-groups"]
        self._run("initdb", "--pgdata", self.folder / "data", "--username", "telltale", "--auth", "trust", "--no-locale")
        self._process = start(stack, [*self._as_user, self._programs / "postgres", "-D", self.folder / "data", "-k",
                                      self.folder, "-c", "listen_addresses="], stderr=subprocess.DEVNULL)
        while subprocess.run([self._programs / "pg_isready", "-q", "-h", self.folder], check=False).returncode != 0:
            time.sleep(0.1)

    def _run(self, program, *arguments):
        subprocess.run([*self._as_user, self._programs / program, *arguments], check=True, stdout=subprocess.DEVNULL)

    def database(self, name):
        self._run("createdb", "-h", self.folder, "-U", "telltale", name)
        return f'database: "postgresql:///{name}?user=telltale&host={self.folder}"\n'

    def cpu_s(self):
        """Of the server and the processes of its connections."""
        children = pathlib.Path(f"/proc/{self._process.pid}/task/{self._process.pid}/children").read_text().split()
        return sum(processor_s(pid) for pid in [self._process.pid, *children])

    def stored_bytes(self):
        return sum(file.stat().st_size for file in self.folder.rglob("*") if file.is_file())


def served(daemon):
    return int(re.search(rb'"vehicles": *(\d+)', daemon.get("/api/v1")).group(1))


def begin(stack, given):
    """The server, and the daemons once each serves its share."""
    folder = pathlib.Path(stack.enter_context(tempfile.TemporaryDirectory()))
    server = PostgresServer(stack, folder)
    fleet = write_vehicles(folder, given.boats // given.domains) + f"slices {{ lease_s: {given.lease} }}\n"
    daemons = []
    for domain in domains_of(given):
        settings = fleet + server.database(f"fleet{domain}")
        daemons += [Daemon(stack, folder, settings, f"telltaled-{domain}-{number}", domain=domain)
                    for number in range(given.daemons // given.domains)]
    while 0 in (shares := list(map(served, daemons))) or sum(shares) != given.boats:
        time.sleep(1)
    print(f"{given.boats} boats in {given.domains} domains, {len(daemons)} daemons that serve {shares}; {given.times} x 65 "
          f"samples/s of each boat, {given.seconds:.0f} s")
    return server, daemons


def domains_of(given):
    return [str(int(DOMAIN) + number) for number in range(given.domains)]


def resident_bytes(daemons):
    return sum(daemon.resident_bytes() for daemon in daemons)


def slices_taken(daemons):
    return sum(int(count) for daemon in daemons for count in re.findall(r"(\d+) of them newly", daemon.log()))


def cores_over(seconds, daemons, server):
    """Cores that each daemon and the server take, on average."""
    before, begun = [one.cpu_s() for one in (*daemons, server)], time.monotonic()
    time.sleep(seconds)
    after, took_s = [one.cpu_s() for one in (*daemons, server)], time.monotonic() - begun
    *cores, of_server = [(later - earlier) / took_s for earlier, later in zip(before, after)]
    return cores, of_server


def main():
    given = given_arguments(__doc__, boats=10000, domains=2, daemons=4, times=0.06, lease=60.0, seconds=120.0)
    with contextlib.ExitStack() as stack:
        server, daemons = begin(stack, given)
        empty = resident_bytes(daemons)
        taken = slices_taken(daemons)
        for domain in domains_of(given):
            start(stack, [*load_command(given.boats // given.domains, domain), "--times", str(given.times), "--duration",
                          "86400"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        for daemon in daemons:
            daemon.await_telemetry()
        cores, server_cores = cores_over(given.seconds, daemons, server)
        for daemon in daemons:
            assert daemon.daemon.poll() is None, daemon.log()
        resident, taken = resident_bytes(daemons), slices_taken(daemons) - taken
        counted = ("vehicle_samples_accepted", "vehicle_samples_lost", "received_samples")
        names = [f"telltale_{name}_total" for name in counted]
        accepted, lost, received = map(sum, zip(*(daemon.totals(*names) for daemon in daemons)))
        dropped = sum(daemon.dropped_packets() for daemon in daemons)
        stored = server.stored_bytes()
    print("cores of each daemon: " + ", ".join(f"{one:.3f}" for one in cores) + f"; of PostgreSQL {server_cores:.3f}")
    print(f"a boat: {1e6 * sum(cores) / given.boats:.1f} us/s of daemons, {1e6 * server_cores / given.boats:.1f} us/s of "
          f"PostgreSQL, {(resident - empty) / given.boats / 1e3:.0f} kB more than without telemetry")
    print(f"resident {resident / 1e6:.0f} MB, {empty / 1e6:.0f} MB before telemetry; the database {stored / 1e6:.0f} MB")
    print(f"received {received:.0f} samples, by each daemon of a domain; accepted {accepted:.0f}, lost {lost:.0f} "
          f"({lost / (accepted + lost):.4%}); packets that the kernel dropped {dropped}")
    print(f"slices whose lease ran out meanwhile: {taken}")


main()
