#!/usr/bin/env python3
"""Writes what write_fixtures.mjs has made in formats for which npm has no writer:

    other_formats.py TELEMETRY_LOG_FOLDER MADE_FOLDER

MADE_FOLDER/{one.csv, log.bin, ros2.db3, ros1-{none,bz2,lz4}.bag, split/}: the log as one CSV and as DataFlash, the
messages of ros2-unchunked.mcap as rosbag2 of sqlite and of two MCAP files, and as recordings of ROS 1. Besides,
resolved/{mavlink,dataflash}: the log as folders of CSV whose numbers are those that these formats can hold.
"""
import bz2
import csv
import math
import pathlib
import sqlite3
import struct
import subprocess
import sys

log, made = map(pathlib.Path, sys.argv[1:])


def rows(channel):
    with open(log / f"{channel}.csv", newline="") as file:
        return [[float(cell) for cell in row] for row in list(csv.reader(file))[1:]]


def single(value):
    return struct.unpack("<f", struct.pack("<f", value))[0]


def nearest(value):  # as Math.round of JavaScript
    return math.floor(value + 0.5)


gnss, heading, thrusters = map(rows, ("gnss", "heading", "thrusters"))
HEADERS = {"gnss": "time_s,latitude_deg,longitude_deg", "heading": "time_s,heading_deg",
           "thrusters": "time_s,left_us,right_us"}


def write_folder(folder, channels):
    folder.mkdir(parents=True)
    for (name, header), samples in zip(HEADERS.items(), channels):
        lines = [",".join(map(repr, row)) for row in samples]
        (folder / f"{name}.csv").write_text("\n".join([header, *lines]) + "\n")


# ---- one CSV, cells empty where a channel has no sample --------------------------------------------------
lines = [(t, repr(t) + f",{lat!r},{lon!r},,,") for t, lat, lon in gnss]
lines += [(t, repr(t) + f",,,{deg!r},,") for t, deg in heading]
lines += [(t, repr(t) + f",,,,{left!r},{right!r}") for t, left, right in thrusters]
lines.sort(key=lambda line: line[0])
(made / "one.csv").write_text("\n".join(["stamp,lat,lon,hdg,pwm_left,pwm_right", *(text for _, text in lines)]) + "\n")

# ---- DataFlash -------------------------------------------------------------------------------------------
FORMATS = {"FMT": (128, "BBnNZ", "Type,Length,Name,Format,Columns"), "PARM": (64, "QNf", "TimeUS,Name,Value"),
           "GPS": (65, "QBBLL", "TimeUS,I,Status,Lat,Lng"), "ATT": (66, "Qf", "TimeUS,Yaw"),
           "RCOU": (67, "QHHH", "TimeUS,C1,C2,C3")}
STRUCT = {"B": "B", "H": "H", "L": "i", "Q": "Q", "f": "f", "n": "4s", "N": "16s", "Z": "64s"}


def record(name, *values):
    kind, fields, _ = FORMATS[name]
    layout = "<" + "".join(STRUCT[field] for field in fields)
    return bytes([0xA3, 0x95, kind]) + struct.pack(layout, *values)


dataflash = []
for name, (kind, fields, columns) in FORMATS.items():
    length = 3 + struct.calcsize("<" + "".join(STRUCT[field] for field in fields))
    dataflash.append(record("FMT", kind, length, name.encode(), fields.encode(), columns.encode()))
for channel, function in ((1, 73), (3, 74)):
    settings = {"FUNCTION": function, "MIN": 1100, "TRIM": 1500, "MAX": 1900, "REVERSED": 0}
    dataflash += [record("PARM", 0, f"SERVO{channel}_{name}".encode(), value) for name, value in settings.items()]
microseconds = [(nearest(row[0] * 1e6), kind, row[1:]) for kind, channel in
                (("GPS", gnss), ("ATT", heading), ("RCOU", thrusters)) for row in channel]
for us, kind, values in sorted(microseconds, key=lambda sample: sample[0]):
    if kind == "GPS":
        dataflash.append(record("GPS", us, 0, 3, *(nearest(value * 1e7) for value in values)))
    elif kind == "ATT":
        dataflash.append(record("ATT", us, values[0]))
    else:
        dataflash.append(record("RCOU", us, nearest(values[0]), 1500, nearest(values[1])))
(made / "log.bin").write_bytes(b"".join(dataflash))

# ---- what MAVLink and DataFlash can hold ------------------------------------------------------------------
DEGREES_PER_RADIAN = 180.0 / math.pi


def yaw(degrees):
    wrapped = math.fmod(math.fmod(degrees + 180, 360) + 360, 360) - 180
    return single(wrapped * math.pi / 180)


fixes = [[nearest(t * 1e6) * 1e-6, nearest(lat * 1e7) / 1e7, nearest(lon * 1e7) / 1e7] for t, lat, lon in gnss]
commands = [[nearest(t * 1e6) * 1e-6, float(nearest(left)), float(nearest(right))] for t, left, right in thrusters]
write_folder(made / "resolved" / "mavlink", (
    fixes, [[nearest(t * 1e3) * 1e-3, yaw(deg) * DEGREES_PER_RADIAN] for t, deg in heading], commands))
write_folder(made / "resolved" / "dataflash", (
    fixes, [[nearest(t * 1e6) * 1e-6, single(deg)] for t, deg in heading], commands))


# ---- ROS 2 messages in other containers -------------------------------------------------------------------
def mcap_records(path):
    content = path.read_bytes()
    at = 8
    while content[at] != 15:  # the end of the data
        length, = struct.unpack_from("<Q", content, at + 1)
        yield content[at], content[at + 9:at + 9 + length], content[at:at + 9 + length]
        at += 9 + length


def texts(content, at, count):
    found = []
    for _ in range(count):
        length, = struct.unpack_from("<I", content, at)
        found.append(content[at + 4:at + 4 + length].decode())
        at += 4 + length
    return found


types, topics, messages, definitions = {}, {}, [], []
for opcode, content, whole in mcap_records(made / "ros2-unchunked.mcap"):
    if opcode == 3:
        types[struct.unpack_from("<H", content)[0]] = texts(content, 2, 1)[0]
    elif opcode == 4:
        number, schema = struct.unpack_from("<HH", content)
        topics[number] = (texts(content, 4, 1)[0], types[schema])
    elif opcode == 5:
        number, _, time_ns = struct.unpack_from("<HIQ", content)
        messages.append((number, time_ns, content[22:], whole))
    if opcode in (1, 3, 4):
        definitions.append(whole)

with sqlite3.connect(made / "ros2.db3") as database:
    database.executescript(
        "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,"
        " serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL);"
        "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL,"
        " data BLOB NOT NULL); CREATE INDEX timestamp_idx ON messages (timestamp ASC);")
    database.executemany("INSERT INTO topics VALUES (?, ?, ?, 'cdr', '')",
                         [(number, *topic) for number, topic in topics.items()])
    database.executemany("INSERT INTO messages(topic_id, timestamp, data) VALUES (?, ?, ?)",
                         [message[:3] for message in messages])

(made / "split").mkdir()
half = len(messages) // 2
for part, some in enumerate((messages[:half], messages[half:])):
    ends = [b"\x0f" + struct.pack("<QI", 4, 0), b"\x02" + struct.pack("<QQQI", 20, 0, 0, 0)]
    magic = b"\x89MCAP0\r\n"
    (made / "split" / f"bag_{part}.mcap").write_bytes(
        b"".join([magic, *definitions, *(message[3] for message in some), *ends, magic]))


# ---- ROS 1 ------------------------------------------------------------------------------------------------
def of_ros1(type_name, cdr):
    """A message of ROS 1 from one of ROS 2 with the frame "map": no alignment, no zeros behind texts."""
    seconds, nanoseconds = struct.unpack_from("<iI", cdr, 4)
    header = struct.pack("<IIII3s", 0, seconds, nanoseconds, 3, b"map")
    if type_name == "sensor_msgs/msg/NavSatFix":
        status, service = struct.unpack_from("<bxH", cdr, 20)
        return header + struct.pack("<bH", status, service) + cdr[28:]
    return header + cdr[20:]


def bag_record(fields, data):
    header = b"".join(struct.pack("<I", len(name) + 1 + len(value)) + name.encode() + b"=" + value
                      for name, value in fields.items())
    return struct.pack("<I", len(header)) + header + struct.pack("<I", len(data)) + data


def field_text(fields):
    return b"".join(struct.pack("<I", len(text)) + text for text in
                    (f"{name}={value}".encode() for name, value in fields.items()))


connections = [
    bag_record({"op": b"\x07", "conn": struct.pack("<I", number), "topic": topic.encode()},
               field_text({"topic": topic, "type": type_name.replace("/msg/", "/"), "md5sum": "0" * 32,
                           "message_definition": ""}))
    for number, (topic, type_name) in topics.items()]
records = [
    bag_record({"op": b"\x02", "conn": struct.pack("<I", number),
                "time": struct.pack("<II", *divmod(time_ns, 1000000000))}, of_ros1(topics[number][1], cdr))
    for number, time_ns, cdr, _ in messages]
COMPRESSIONS = {"none": bytes, "bz2": bz2.compress,
                "lz4": lambda data: subprocess.run(["lz4", "-q", "-c"], input=data, capture_output=True, check=True).stdout}
for compression, compress in COMPRESSIONS.items():
    chunks = []
    for begin in range(0, len(records), 2000):
        data = b"".join((connections if begin == 0 else []) + records[begin:begin + 2000])
        chunks.append(bag_record({"op": b"\x05", "compression": compression.encode(),
                                  "size": struct.pack("<I", len(data))}, compress(data)))
    (made / f"ros1-{compression}.bag").write_bytes(b"#ROSBAG V2.0\n" + b"".join(chunks))
