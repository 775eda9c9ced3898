"""A small network of namespaces on this machine, whose faults a test commands.

Each host is a network namespace with one interface, `eth0`. A switch in this process joins them: it hands every frame of a
host to all others, and loses, repeats, delays or withholds frames as it is told. It needs no queueing discipline of the
kernel, draws its random numbers from a seed, and needs root and /dev/net/tun.
"""
import fcntl
import heapq
import os
import random
import select
import struct
import subprocess
import threading
import time
from dataclasses import dataclass

TUNSETIFF = 0x400454CA
IFF_TAP = 0x0002
IFF_NO_PI = 0x1000
FRAME_BYTES = 2048


def ip(*words):
    subprocess.run(["ip", *words], check=True, stderr=subprocess.PIPE, text=True)


@dataclass
class Faults:
    """What happens to each frame on its way to one host. Shares are in [0, 1]."""

    lost: float = 0.0
    repeated: float = 0.0
    late: float = 0.0  # overtaken by those behind it
    late_by_s: float = 0.05


class FaultyNetwork:
    """`with FaultyNetwork(["shore", "boat"], seed=1) as network:`; hosts have the addresses 10.77.0.1 and on."""

    def __init__(self, hosts, seed):
        self._faults = Faults()
        self._cut_off = set()
        self._down = set()
        self._random = random.Random(seed)
        self._prefix = f"tt{os.getpid()}"
        self._taps = {host: self._connect(number, host) for number, host in enumerate(hosts, 1)}
        self._delayed = []  # (when, number, host, frame)
        self._sent = 0
        self._stopping = threading.Event()
        self._thread = threading.Thread(target=self._switch, daemon=True)

    def __enter__(self):
        self._thread.start()
        return self

    def __exit__(self, *_):
        self._stopping.set()
        self._thread.join()
        for host, tap in self._taps.items():
            os.close(tap)
            ip("netns", "del", self.namespace(host))

    def namespace(self, host):
        return f"{self._prefix}-{host}"

    def command(self, host, words):
        """The command line that runs `words` on a host."""
        return ["ip", "netns", "exec", self.namespace(host), *words]

    def disturb(self, **shares):
        """What happens to every frame from now on, as in Faults."""
        self._faults = Faults(**shares)

    def cut_off(self, host):
        """No frame leaves or reaches the host any more, which does not notice."""
        self._cut_off.add(host)

    def take_down(self, host):
        """The interface of the host is down, as when a cable is pulled."""
        ip("-n", self.namespace(host), "link", "set", "eth0", "down")
        self._down.add(host)

    def mend(self):
        """Ends all of these."""
        self._faults = Faults()
        self._cut_off.clear()
        for host in self._down:
            ip("-n", self.namespace(host), "link", "set", "eth0", "up")
        self._down.clear()

    def _connect(self, number, host):
        namespace = self.namespace(host)
        tap = os.open("/dev/net/tun", os.O_RDWR | os.O_NONBLOCK)
        device = f"{self._prefix}{number}"
        fcntl.ioctl(tap, TUNSETIFF, struct.pack("16sH", device.encode(), IFF_TAP | IFF_NO_PI))
        ip("netns", "add", namespace)
        ip("link", "set", device, "netns", namespace)
        ip("-n", namespace, "link", "set", device, "name", "eth0")
        ip("-n", namespace, "addr", "add", f"10.77.0.{number}/24", "dev", "eth0")
        ip("-n", namespace, "link", "set", "lo", "up")
        ip("-n", namespace, "link", "set", "eth0", "multicast", "on", "up")
        return tap

    def _switch(self):
        hosts = {tap: host for host, tap in self._taps.items()}
        while not self._stopping.is_set():
            ready, _, _ = select.select(list(hosts), [], [], self._patience())
            for tap in ready:
                self._forward(hosts[tap], tap)
            while self._delayed and self._delayed[0][0] <= time.monotonic():
                _, _, host, frame = heapq.heappop(self._delayed)
                self._deliver(host, frame)

    def _patience(self):
        return max(0.0, min(0.02, self._delayed[0][0] - time.monotonic())) if self._delayed else 0.02

    def _forward(self, sender, tap):
        try:
            frame = os.read(tap, FRAME_BYTES)
        except OSError:  # the interface is down
            return
        for host in self._taps:
            if host != sender:
                self._send(sender, host, frame)

    def _send(self, sender, host, frame):
        faults = self._faults
        if self._cut_off & {sender, host} or self._random.random() < faults.lost:
            return
        if self._random.random() < faults.repeated:
            self._deliver(host, frame)
        if self._random.random() < faults.late:
            self._sent += 1  # orders those that are due at once
            due = time.monotonic() + self._random.uniform(0.0, faults.late_by_s)
            heapq.heappush(self._delayed, (due, self._sent, host, frame))
        else:
            self._deliver(host, frame)

    def _deliver(self, host, frame):
        try:
            os.write(self._taps[host], frame)
        except OSError:  # the interface is down, or its queue is full
            pass
