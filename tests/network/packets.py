#!/usr/bin/env python3
"""Packets that no participant of a DDS domain sends, for tests that attack one on this machine.

  packets.py record --port P... --seconds S --out FILE    what reaches these UDP ports over the loopback interface
  packets.py replay --file FILE --times N                 sends what was recorded again, from another port
  packets.py flood --port P... --packets N --seed N [--file FILE]
      random bytes, RTPS headers with random bodies and, with a file, recorded packets with some bits changed
Each prints how many packets it has seen or sent. `record` needs root.
"""
import argparse
import random
import socket
import struct
import sys
import time

UDP = 17
RTPS_HEADER = b"RTPS\x02\x01\x01\x10"


def datagram_of(frame):
    """(destination port, payload) of a frame with a whole IPv4 UDP datagram, else nothing."""
    if len(frame) < 42 or frame[12:14] != b"\x08\x00" or frame[23] != UDP:
        return None
    header = 14 + 4 * (frame[14] & 0x0F)
    _, port, length = struct.unpack("!HHH", frame[header:header + 6])
    payload = frame[header + 8:header + length]
    return (port, payload) if len(payload) == length - 8 else None


def record(ports, seconds):
    """The datagrams that reach the ports, each once."""
    tap = socket.socket(socket.AF_PACKET, socket.SOCK_RAW, socket.htons(0x0003))
    tap.bind(("lo", 0))
    tap.settimeout(0.1)
    end = time.monotonic() + seconds
    datagrams = []
    while time.monotonic() < end:
        try:
            frame, address = tap.recvfrom(65600)
        except TimeoutError:
            continue
        if address[2] == socket.PACKET_OUTGOING:  # the loopback interface shows each frame twice
            continue
        datagram = datagram_of(frame)
        if datagram and datagram[0] in ports:
            datagrams.append(datagram)
    return datagrams


def write(datagrams, path):
    with open(path, "wb") as file:
        for port, payload in datagrams:
            file.write(struct.pack("!HH", port, len(payload)) + payload)


def read(path):
    datagrams = []
    with open(path, "rb") as file:
        while header := file.read(4):
            port, length = struct.unpack("!HH", header)
            datagrams.append((port, file.read(length)))
    return datagrams


def send(datagrams):
    sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    sent = 0
    for port, payload in datagrams:
        try:
            sender.sendto(payload, ("127.0.0.1", port))
            sent += 1
        except OSError:  # nobody listens, or the queue is full
            pass
    return sent


def malformed(ports, count, recorded, rng):
    for number in range(count):
        kind = number % (3 if recorded else 2)
        if kind == 0:
            payload = rng.randbytes(rng.randrange(1, 1400))
        elif kind == 1:
            payload = RTPS_HEADER + rng.randbytes(rng.randrange(12, 1400))
        else:
            payload = bytearray(rng.choice(recorded)[1])
            for _ in range(rng.randrange(1, 9)):
                payload[rng.randrange(len(payload))] ^= 1 << rng.randrange(8)
        yield rng.choice(ports), bytes(payload)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    recording = commands.add_parser("record")
    recording.add_argument("--port", type=int, nargs="+", required=True)
    recording.add_argument("--seconds", type=float, required=True)
    recording.add_argument("--out", required=True)
    replaying = commands.add_parser("replay")
    replaying.add_argument("--file", required=True)
    replaying.add_argument("--times", type=int, default=1)
    flooding = commands.add_parser("flood")
    flooding.add_argument("--port", type=int, nargs="+", required=True)
    flooding.add_argument("--packets", type=int, required=True)
    flooding.add_argument("--seed", type=int, required=True)
    flooding.add_argument("--file")
    arguments = parser.parse_args()
    if arguments.command == "record":
        datagrams = record(arguments.port, arguments.seconds)
        write(datagrams, arguments.out)
        print(len(datagrams))
    elif arguments.command == "replay":
        print(send(read(arguments.file) * arguments.times))
    else:
        recorded = read(arguments.file) if arguments.file else []
        print(send(malformed(arguments.port, arguments.packets, recorded, random.Random(arguments.seed))))


if __name__ == "__main__":
    sys.exit(main())
