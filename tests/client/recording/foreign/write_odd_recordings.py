#!/usr/bin/env python3
"""Writes one telemetry log as files that users have and that are odd, for which npm has no writer:

    write_odd_recordings.py TELEMETRY_LOG_FOLDER MADE_FOLDER

MADE_FOLDER/{european,iso}.csv with their mappings .textproto, odometry.textproto for odometry.mcap of
write_odd_recordings.mjs, power-off.bin: DataFlash as ArduPilot 4.5 writes it,
with two receivers and cut off.
"""
import csv
import datetime
import pathlib
import struct
import sys

EPOCH_S = 1700000000.0
log, made = map(pathlib.Path, sys.argv[1:])


def rows(channel):
    with open(log / f"{channel}.csv", newline="") as file:
        return [(float(row[0]), channel, [float(cell) for cell in row[1:]]) for row in list(csv.reader(file))[1:]]


samples = sorted(rows("gnss") + rows("heading") + rows("thrusters"), key=lambda sample: sample[0])
CELLS = {"gnss": slice(0, 2), "heading": slice(2, 3), "thrusters": slice(3, 5)}


def table(name, header, separator, time_text, number_text, missing, before="", ending="\n"):
    lines = [separator.join(header)]
    for t, channel, values in samples:
        cells = [missing] * 5
        cells[CELLS[channel]] = [number_text(value) for value in values]
        lines.append(separator.join([time_text(t), *cells]))
    (made / name).write_bytes((before + ending.join(lines) + ending).encode())


# A spreadsheet in Europe: byte order mark, CRLF, semicolons, decimal commas, milliseconds since 1970.
table("european.csv", ["Zeit [ms]", "Breite", "Länge", "Kurs [°]", "PWM links", "PWM rechts"], ";",
      lambda t: f"{(EPOCH_S + t) * 1e3:.1f}".replace(".", ","), lambda value: repr(value).replace(".", ","), "",
      before="\ufeff", ending="\r\n")
(made / "european.textproto").write_text("""
time { field: "Zeit [ms]" unit: "ms" }
positions { latitude: "Breite" longitude: "Länge" }
headings { field: "Kurs [°]" }
port { field: "PWM links" }
starboard { field: "PWM rechts" }
""")
# pandas: ISO times, NaN where there is nothing.
table("iso.csv", ["time", "lat", "lon", "heading", "left", "right"], ",",
      lambda t: datetime.datetime.fromtimestamp(EPOCH_S + t, datetime.timezone.utc).isoformat(sep=" "), repr, "NaN")
(made / "iso.textproto").write_text("""
time { field: "time" }
positions { latitude: "lat" longitude: "lon" }
headings { field: "heading" }
port { field: "left" }
starboard { field: "right" }
""")

# For odometry.mcap of write_odd_recordings.mjs.
(made / "odometry.textproto").write_text("""
positions { topic: "/odometry/filtered" north: "pose.pose.position.y" east: "pose.pose.position.x" }
headings { topic: "/odometry/filtered" field: "pose.pose.orientation" unit: "quaternion" frame: "ENU" }
port { topic: "*/left/cmd" field: "data" unit: "N" full_forward: 50 full_reverse: -50 }
starboard { topic: "*/right/cmd" field: "data" unit: "N" full_forward: 50 full_reverse: -50 }
""")

# ---- DataFlash of ArduPilot 4.5 ---------------------------------------------------------------------------
FORMATS = {
    "FMT": (128, "BBnNZ", "Type,Length,Name,Format,Columns"),
    "PARM": (64, "QNff", "TimeUS,Name,Value,Default"),
    "GPS": (65, "QBBIHBcLLeffffB", "TimeUS,I,Status,GMS,GWk,NSats,HDop,Lat,Lng,Alt,Spd,GCrs,VZ,Yaw,U"),
    "ATT": (66, "QccccCCCCB", "TimeUS,DesRoll,Roll,DesPitch,Pitch,DesYaw,Yaw,ErrRP,ErrYaw,AEKF"),
    "AHR2": (67, "QccCfLLffff", "TimeUS,Roll,Pitch,Yaw,Alt,Lat,Lng,Q1,Q2,Q3,Q4"),
    "RCOU": (68, "QHHHHHHHHHHHHHH", "TimeUS," + ",".join(f"C{n}" for n in range(1, 15))),
    "XKF1": (69, "QBccCfffffffccce", "TimeUS,C,Roll,Pitch,Yaw,VN,VE,VD,dPD,PN,PE,PD,GX,GY,GZ,OH"),
    "ARM": (70, "QBIBB", "TimeUS,ArmState,ArmChecks,Forced,Method"),
}
STRUCT = {"B": "B", "H": "H", "I": "I", "L": "i", "Q": "Q", "f": "f", "c": "h", "C": "H", "e": "i", "n": "4s",
          "N": "16s", "Z": "64s"}


def layout(name):
    return "<" + "".join(STRUCT[field] for field in FORMATS[name][1])


def record(name, *values):
    return bytes([0xA3, 0x95, FORMATS[name][0]]) + struct.pack(layout(name), *values)


def nearest(value):
    return int(value + 0.5) if value >= 0 else -int(0.5 - value)


content = [record("FMT", kind, 3 + struct.calcsize(layout(name)), name.encode(), fields.encode(), columns.encode())
           for name, (kind, fields, columns) in FORMATS.items()]
BOOT_US = 41_000_000
for channel, function in ((1, 73), (3, 74)):
    settings = {"FUNCTION": function, "MIN": 1100, "TRIM": 1500, "MAX": 1900, "REVERSED": 0}
    content += [record("PARM", BOOT_US, f"SERVO{channel}_{name}".encode(), value, 0.0)
                for name, value in settings.items()]
content.append(record("ARM", BOOT_US, 1, 0, 0, 0))
for t, channel, values in samples:
    us = BOOT_US + nearest(t * 1e6)
    if channel == "gnss":
        latitude, longitude = (nearest(value * 1e7) for value in values)
        for instance in (0, 1):
            content.append(record("GPS", us, instance, 4, 0, 2300, 18, 70, latitude + 90 * instance, longitude, 0,
                                  0.0, 0.0, 0.0, 0.0, 1 - instance))
    elif channel == "heading":
        yaw = nearest(values[0] % 360 * 100) % 36000
        content.append(record("XKF1", us, 0, 0, 0, yaw, *[0.0] * 7, 0, 0, 0, 0))
        content.append(record("AHR2", us, 0, 0, (yaw + 300) % 36000, 0.0, 0, 0, 1.0, 0.0, 0.0, 0.0))
        content.append(record("ATT", us, 0, 0, 0, 0, yaw, yaw, 0, 0, 3))
    else:
        content.append(record("RCOU", us, nearest(values[0]), 0, nearest(values[1]), *[0] * 11))
(made / "power-off.bin").write_bytes(b"".join(content)[:-7] + bytes(4096))
