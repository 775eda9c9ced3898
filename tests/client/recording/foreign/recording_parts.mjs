// What the programs share that write one telemetry log as other systems record it: its samples, and writers of
// MAVLink, MCAP and messages of ROS 2 that are not ours.
import { createRequire } from "node:module";
import { readFileSync, openSync, writeSync, closeSync } from "node:fs";
import { join } from "node:path";

const require = createRequire(import.meta.url);
const { McapWriter } = require("@mcap/core");
const { parse } = require("@foxglove/rosmsg");
const { MessageWriter } = require("@foxglove/rosmsg2-serialization");
export const mavlink = require("node-mavlink");
const { common } = mavlink;

export const epoch = 1700000000; // when the log is said to have been recorded, s since 1970
export const nanoseconds = (t) => BigInt(Math.round((epoch + t) * 1e6)) * 1000n;
export const zeros = (count) => new Array(count).fill(0);

// The samples of a telemetry log in the order of time, each of kind fix, heading or pulses.
export function samplesOf(folder) {
  const rows = (name) => readFileSync(join(folder, name), "utf8").trim().split("\n").slice(1)
    .map((line) => line.split(",").map(Number));
  return [
    ...rows("gnss.csv").map(([t, lat, lon]) => ({ t, kind: "fix", lat, lon })),
    ...rows("heading.csv").map(([t, deg]) => ({ t, kind: "heading", deg })),
    ...rows("thrusters.csv").map(([t, port, starboard]) => ({ t, kind: "pulses", port, starboard })),
  ].sort((a, b) => a.t - b.t);
}

// --- MAVLink -----------------------------------------------------------------------------------
export const make = (Type, fields) => Object.assign(new Type(), fields);

export const radians = (deg) => ((((deg + 180) % 360) + 360) % 360 - 180) * Math.PI / 180;

export function skidSteerParameters({ reversed = [] } = {}) {
  const parameters = { SERVO1_FUNCTION: 73, SERVO3_FUNCTION: 74 };
  for (const channel of [1, 3]) {
    Object.assign(parameters, { [`SERVO${channel}_MIN`]: 1100, [`SERVO${channel}_TRIM`]: 1500,
      [`SERVO${channel}_MAX`]: 1900, [`SERVO${channel}_REVERSED`]: reversed.includes(channel) ? 1 : 0 });
  }
  return Object.entries(parameters).map(([paramId, paramValue]) => make(common.ParamValue,
    { paramId, paramValue, paramCount: 10, paramIndex: 0, paramType: 9 }));
}

// The messages in which an autopilot says what a sample does; times count from its boot.
export const gpsRawInt = (s) => make(common.GpsRawInt, { timeUsec: BigInt(Math.round(s.t * 1e6)),
  lat: Math.round(s.lat * 1e7), lon: Math.round(s.lon * 1e7), alt: 0, eph: 100, epv: 100, vel: 0, cog: 0,
  fixType: 3, satellitesVisible: 12 });
export const attitude = (s) => make(common.Attitude, { timeBootMs: Math.round(s.t * 1e3), roll: 0, pitch: 0,
  yaw: radians(s.deg), rollspeed: 0, pitchspeed: 0, yawspeed: 0 });
export function servoOutputRaw(s) {
  const m = make(common.ServoOutputRaw, { timeUsec: Math.round(s.t * 1e6) % 4294967296, port: 0 });
  for (let i = 1; i <= 16; ++i) m[`servo${i}Raw`] = 0;
  return Object.assign(m, { servo1Raw: Math.round(s.port), servo3Raw: Math.round(s.starboard) });
}
export const mavlinkOf = { fix: gpsRawInt, heading: attitude, pulses: servoOutputRaw };

// A telemetry log of a ground station: each frame behind the time at which it came.
export class Tlog {
  constructor(path) {
    this.file = openSync(path, "w");
    this.sequence = 0;
  }
  put(t, frame) {
    const stamp = Buffer.alloc(8);
    stamp.writeBigUInt64BE(BigInt(Math.round((epoch + t) * 1e6)));
    writeSync(this.file, stamp);
    writeSync(this.file, frame);
  }
  send(t, message, protocol) { this.put(t, protocol.serialize(message, this.sequence++ & 255)); }
  end() { closeSync(this.file); }
}

// The same frames as they come out of a serial line.
export class BareFrames extends Tlog {
  put(t, frame) { writeSync(this.file, frame); }
}

// --- MCAP --------------------------------------------------------------------------------------
class FileWritable {
  constructor(path) { this.file = openSync(path, "w"); this.size = 0n; }
  position() { return this.size; }
  async write(buffer) { writeSync(this.file, buffer); this.size += BigInt(buffer.byteLength); }
  close() { closeSync(this.file); }
}

async function mcapWriter(path, profile, options) {
  const writable = new FileWritable(path);
  const writer = new McapWriter({ writable, ...options });
  await writer.start({ profile, library: "fixtures" });
  return { writer, end: async () => { await writer.end(); writable.close(); } };
}

const snake = (name) => name.replace(/[A-Z]/g, (c) => "_" + c.toLowerCase())
  .replace(/([a-z])(\d)/, "$1$2");
const upperSnake = (name) => name.replace(/(?<=[a-z])[A-Z]/g, (c) => "_" + c).toUpperCase();

// The recorder of BlueOS: messages as the JSON of mavlink2rest, a topic for each.
export async function blueOsRecorder(path, { topicPrefix = "mavlink/" } = {}) {
  const { writer, end } = await mcapWriter(path, "", { useChunks: true });
  const channels = new Map();
  const write = async (t, m, { system = 1, component = 1 } = {}) => {
    const type = upperSnake(m.constructor.MSG_NAME ?? m.constructor.name);
    const topic = `${topicPrefix}${system}/${component}/${type}`;
    if (!channels.has(topic)) {
      const schemaId = await writer.registerSchema(
        { name: type, encoding: "jsonschema", data: Buffer.from('{"type":"object"}') });
      channels.set(topic, await writer.registerChannel(
        { schemaId, topic, messageEncoding: "json", metadata: new Map() }));
    }
    const message = { type };
    for (const [key, value] of Object.entries(m)) {
      message[snake(key)] = typeof value === "bigint" ? Number(value) : value;
    }
    if (type === "PARAM_VALUE") {
      message.param_id = [...m.paramId.padEnd(16, "\0")];
    }
    if (type === "GPS_RAW_INT") message.fix_type = { type: "GPS_FIX_TYPE_3D_FIX" };
    const ns = nanoseconds(t);
    await writer.addMessage({ channelId: channels.get(topic), sequence: 0, logTime: ns,
      publishTime: ns, data: Buffer.from(JSON.stringify(
        { header: { system_id: system, component_id: component, sequence: 0 }, message })) });
  };
  return { write, end };
}

// --- ROS 2 -------------------------------------------------------------------------------------
const parts = {
  "std_msgs/Header": "builtin_interfaces/Time stamp\nstring frame_id\n",
  "builtin_interfaces/Time": "int32 sec\nuint32 nanosec\n",
  "sensor_msgs/NavSatStatus": "int8 status\nuint16 service\n",
  "geometry_msgs/Point": "float64 x\nfloat64 y\nfloat64 z\n",
  "geometry_msgs/Quaternion": "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n",
  "geometry_msgs/Vector3": "float64 x\nfloat64 y\nfloat64 z\n",
  "geometry_msgs/Pose": "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n",
  "geometry_msgs/PoseWithCovariance": "geometry_msgs/Pose pose\nfloat64[36] covariance\n",
  "geometry_msgs/Twist": "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n",
  "geometry_msgs/TwistWithCovariance": "geometry_msgs/Twist twist\nfloat64[36] covariance\n",
  "geographic_msgs/GeoPoint": "float64 latitude\nfloat64 longitude\nfloat64 altitude\n",
  "geographic_msgs/GeoPose": "geographic_msgs/GeoPoint position\ngeometry_msgs/Quaternion orientation\n",
};
const messages = {
  "std_msgs/msg/Float64": "float64 data\n",
  "sensor_msgs/msg/NavSatFix": `std_msgs/Header header
sensor_msgs/NavSatStatus status
float64 latitude
float64 longitude
float64 altitude
float64[9] position_covariance
uint8 position_covariance_type
`,
  "sensor_msgs/msg/Imu": `std_msgs/Header header
geometry_msgs/Quaternion orientation
float64[9] orientation_covariance
geometry_msgs/Vector3 angular_velocity
float64[9] angular_velocity_covariance
geometry_msgs/Vector3 linear_acceleration
float64[9] linear_acceleration_covariance
`,
  "nav_msgs/msg/Odometry": `std_msgs/Header header
string child_frame_id
geometry_msgs/PoseWithCovariance pose
geometry_msgs/TwistWithCovariance twist
`,
  "geometry_msgs/msg/PoseStamped": "std_msgs/Header header\ngeometry_msgs/Pose pose\n",
  "geographic_msgs/msg/GeoPoseStamped": "std_msgs/Header header\ngeographic_msgs/GeoPose pose\n",
  "mavros_msgs/msg/RCOut": "std_msgs/Header header\nuint16[] channels\n",
  "mavros_msgs/msg/RCIn": "std_msgs/Header header\nuint8 rssi\nuint16[] channels\n",
  "mavros_msgs/msg/OverrideRCIn": "uint16[18] channels\n",
};

// The definition of a message with those of its parts behind it, as MCAP holds it.
export function definitionOf(type) {
  const wanted = (text) => [...text.matchAll(/^([a-z_]+\/[A-Za-z0-9]+)/gm)].map((found) => found[1]);
  const names = [...wanted(messages[type])];
  for (const name of names) {
    for (const part of wanted(parts[name])) if (!names.includes(part)) names.push(part);
  }
  return messages[type] + [...new Set(names)]
    .map((name) => `${"=".repeat(80)}\nMSG: ${name}\n${parts[name]}`).join("");
}

const vector = { x: 0, y: 0, z: 0 };
// East-north-up, as ROS has it: yaw = 90 deg - heading.
export function orientation(deg) {
  const half = (90 - deg) * Math.PI / 360;
  return { x: 0, y: 0, z: Math.sin(half), w: Math.cos(half) };
}
export const navSatFix = (s) => ({ status: { status: 0, service: 1 }, latitude: s.lat, longitude: s.lon,
  altitude: 0, position_covariance: zeros(9), position_covariance_type: 0 });
export const imu = (s) => ({ orientation: orientation(s.deg), orientation_covariance: zeros(9),
  angular_velocity: vector, angular_velocity_covariance: zeros(9), linear_acceleration: vector,
  linear_acceleration_covariance: zeros(9) });
export const odometry = (position, deg) => ({ child_frame_id: "base_link",
  pose: { pose: { position, orientation: orientation(deg) }, covariance: zeros(36) },
  twist: { twist: { linear: vector, angular: vector }, covariance: zeros(36) } });

// ros2 bag, with MCAP. `stamp_t` gives a message its header.
export async function ros2Recorder(path, options = { useChunks: true }) {
  const { writer, end } = await mcapWriter(path, "ros2", options);
  const topics = new Map();
  const topicOf = async (topic, type) => {
    if (!topics.has(topic)) {
      const definition = definitionOf(type);
      const schemaId = await writer.registerSchema(
        { name: type, encoding: "ros2msg", data: Buffer.from(definition) });
      topics.set(topic, { serialiser: new MessageWriter(parse(definition, { ros2: true })),
        channelId: await writer.registerChannel(
          { schemaId, topic, messageEncoding: "cdr", metadata: new Map() }) });
    }
    return topics.get(topic);
  };
  const write = async (recorded_t, topic, type, message, { stamp_t, frame = "map" } = {}) => {
    const { serialiser, channelId } = await topicOf(topic, type);
    if (stamp_t !== undefined) {
      const stamp = nanoseconds(stamp_t);
      message = { header: { stamp: { sec: Number(stamp / 1000000000n),
        nanosec: Number(stamp % 1000000000n) }, frame_id: frame }, ...message };
    }
    const ns = nanoseconds(recorded_t);
    await writer.addMessage({ channelId, sequence: 0, logTime: ns, publishTime: ns,
      data: serialiser.writeMessage(message) });
  };
  return { write, end };
}
