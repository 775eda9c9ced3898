#!/usr/bin/python3
"""Writes one telemetry log as boats under ROS 1 record it, by Debian's rosbag:

    write_ros1.py TELEMETRY_LOG_FOLDER OUT_FOLDER

OUT_FOLDER/heron.bag: Clearpath's Heron, whose commands are shares of full thrust; OUT_FOLDER/mavros-ros1.bag: MAVROS
1 with fixes at 5 Hz and outputs at 10 Hz. Names, types, units and frames are those that these systems publish.
"""
import csv
import math
import pathlib
import sys

import genpy
import genpy.dynamic
import rosbag

EPOCH_S = 1700000000
log, out = map(pathlib.Path, sys.argv[1:])
out.mkdir(parents=True, exist_ok=True)

LINE = "=" * 80 + "\nMSG: "
HEADER = LINE + "std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n"
STATUS = LINE + "sensor_msgs/NavSatStatus\nint8 status\nuint16 service\n"
QUATERNION = LINE + "geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"
VECTOR = LINE + "geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n"
DEFINITIONS = {
    "sensor_msgs/NavSatFix": "Header header\nsensor_msgs/NavSatStatus status\nfloat64 latitude\nfloat64 longitude\n"
                             "float64 altitude\nfloat64[9] position_covariance\nuint8 position_covariance_type\n"
                             + HEADER + STATUS,
    "sensor_msgs/Imu": "Header header\ngeometry_msgs/Quaternion orientation\nfloat64[9] orientation_covariance\n"
                       "geometry_msgs/Vector3 angular_velocity\nfloat64[9] angular_velocity_covariance\n"
                       "geometry_msgs/Vector3 linear_acceleration\nfloat64[9] linear_acceleration_covariance\n"
                       + HEADER + QUATERNION + VECTOR,
    "geometry_msgs/Twist": "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n" + VECTOR,
    "heron_msgs/Drive": "float32 left\nfloat32 right\n",
    "std_msgs/Float64": "float64 data\n",
    "mavros_msgs/RCOut": "Header header\nuint16[] channels\n" + HEADER,
    "mavros_msgs/OverrideRCIn": "uint16[8] channels\n",
}
TYPES = {name: genpy.dynamic.generate_dynamic(name, text)[name] for name, text in DEFINITIONS.items()}


def rows(channel):
    with open(log / f"{channel}.csv", newline="") as file:
        for row in list(csv.reader(file))[1:]:
            values = [float(cell) for cell in row]
            yield values[0], channel, values[1:]


samples = sorted((sample for channel in ("gnss", "heading", "thrusters") for sample in rows(channel)),
                 key=lambda sample: sample[0])


def time_of(seconds):
    nanoseconds = round(seconds * 1e6) * 1000
    return genpy.Time(EPOCH_S + nanoseconds // 10**9, nanoseconds % 10**9)


def message(name, at=None, frame="", **fields):
    made = TYPES[name]()
    if at is not None:
        made.header.stamp = time_of(at)
        made.header.frame_id = frame
    for field, value in fields.items():
        setattr(made, field, value)
    return made


def fix(t, latitude, longitude, frame):
    return message("sensor_msgs/NavSatFix", t, frame, latitude=latitude, longitude=longitude)


def imu(t, degrees, frame):
    made = message("sensor_msgs/Imu", t, frame)
    half = math.radians(90 - degrees) / 2
    made.orientation.z, made.orientation.w = math.sin(half), math.cos(half)
    return made


def write_heron():
    with rosbag.Bag(str(out / "heron.bag"), "w", compression="lz4") as bag:
        for t, channel, values in samples:
            at = time_of(t)
            if channel == "gnss":
                bag.write("/navsat/fix", fix(t - 0.003, *values, "navsat_link"), at)
                bag.write("/cmd_vel", message("geometry_msgs/Twist"), at)
            elif channel == "heading":
                bag.write("/imu/data_raw", imu(t - 0.003, 12.0, "imu_link"), at)
                bag.write("/imu/data", imu(t - 0.003, *values, "imu_link"), at)
            else:
                left, right = ((us - 1500) / 400 for us in values)
                bag.write("/cmd_drive", message("heron_msgs/Drive", left=left, right=right), at)


def write_mavros():
    with rosbag.Bag(str(out / "mavros-ros1.bag"), "w", compression="bz2") as bag:
        for t, channel, values in samples:
            at = time_of(t)
            if channel == "gnss":
                bag.write("/mavros/global_position/raw/fix", fix(t - 0.003, *values, "base_link"), at)
            elif channel == "heading":
                bag.write("/mavros/imu/data", imu(t - 0.003, *values, "base_link"), at)
                bag.write("/mavros/global_position/compass_hdg", message("std_msgs/Float64", data=values[0] % 360), at)
            else:
                channels = [round(values[0]), 1500, round(values[1]), 1500, 0, 0, 0, 0]
                bag.write("/mavros/rc/override", message("mavros_msgs/OverrideRCIn", channels=[1600] * 8), at)
                bag.write("/mavros/rc/out", message("mavros_msgs/RCOut", t - 0.003, channels=channels), at)


write_heron()
write_mavros()
