"""Builds what the tests of the page show: a daemon of many boats, and one of six that it restarts when asked.

  page_test.py MODULES PICTURES BROWSER    MODULES: a folder with node_modules and tests/web/*.mjs
"""
import subprocess
import sys

from real_daemon import BOAT, TOKEN, Daemon, until


def finish(daemon, kind, boat=BOAT):
    status, headers, job = daemon.order(kind, boat)
    assert status == 202, job
    done = until(lambda: ended(daemon.get(headers["Location"])), f"{kind} of {boat}", 300)
    assert done["state"] == "PUBLISHED", done


def ended(job):
    return job if job["state"] != "RUNNING" else None


def on_the_map(daemon):
    """The verdicts of the boats that have a position."""
    fleet = daemon.get("/api/v1/vehicles?limit=1000")["vehicles"]
    return [vehicle["verdict"] for vehicle in fleet if "position" in vehicle]


MANY_BOATS = 1000


def main(modules, pictures, browser):
    with Daemon(more=MANY_BOATS - 1, named="load-{:05}") as daemon:
        code = walk(daemon, modules, "large_fleet_test.mjs", browser, MANY_BOATS)
        if code != 0:
            sys.exit(code)
        with daemon.loading(MANY_BOATS - 2):
            until(lambda: len(on_the_map(daemon)) == MANY_BOATS - 2, "a position of every boat that sends")
        with daemon.loading(MANY_BOATS // 2):
            until(lambda: len(set(on_the_map(daemon))) > 1, "another verdict of boats that fell silent")
            code = walk(daemon, modules, "fleet_map_test.mjs", browser, MANY_BOATS, pictures)
        if code != 0:
            sys.exit(code)
    with Daemon(more=5) as daemon:
        daemon.replay(last_s=250)
        finish(daemon, "refresh")
        daemon.replay(first_s=250.01, last_s=400)
        finish(daemon, "refresh")
        daemon.replay(first_s=400.01)
        finish(daemon, "diagnose")
        daemon.replay("boat-0001", last_s=300)
        until(lambda: daemon.ask("GET", f"/api/v1/vehicles/{BOAT}/diagnosis")[0] == 200, "the diagnosis")
        with daemon.replaying("boat-0001", first_s=300.01):
            until(lambda: daemon.get("/api/v1/vehicles/boat-0001")["verdict"] != "STALE", "a live boat")
            sys.exit(walk(daemon, modules, "page_test.mjs", browser, BOAT, TOKEN, pictures))


def walk(daemon, modules, test, browser, *arguments):
    """Runs the test on the page of the daemon, and gives back its exit code."""
    page = subprocess.Popen(["node", test, daemon.address, browser, *map(str, arguments)],
                            cwd=modules, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    for line in page.stdout:
        print(line, end="", flush=True)
        if line == "RESTART\n":
            daemon.stop()
        if line == "START\n":
            daemon.config.write_text(daemon.config.read_text().replace("port: 0 ", f"port: {daemon.port} "))
            daemon.start()
            page.stdin.write("restarted\n")
            page.stdin.flush()
    return page.wait()


main(*sys.argv[1:])
