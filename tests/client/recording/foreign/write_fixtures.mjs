// Writes one telemetry log in formats of other programs, by their own writers:
//
//   node write_fixtures.mjs TELEMETRY_LOG_FOLDER OUT_FOLDER
//
// OUT_FOLDER/{log.tlog, blueos.mcap, ros2-{none,lz4,zstd,unchunked}.mcap}
import { createRequire } from "node:module";
import { mkdirSync, readFileSync, writeFileSync, openSync, writeSync, closeSync } from "node:fs";
import { join } from "node:path";
import { execFileSync } from "node:child_process";

const require = createRequire(import.meta.url);
const { McapWriter } = require("@mcap/core");
const { parse } = require("@foxglove/rosmsg");
const { MessageWriter } = require("@foxglove/rosmsg2-serialization");
const mavlink = require("node-mavlink");
const zstd = require("@foxglove/wasm-zstd");

const [folder, out] = process.argv.slice(2);
mkdirSync(out, { recursive: true });

const rows = (name) =>
  readFileSync(join(folder, name), "utf8").trim().split("\n").slice(1)
    .map((line) => line.split(",").map(Number));
const samples = [
  ...rows("gnss.csv").map(([t, lat, lon]) => ({ t, kind: "fix", lat, lon })),
  ...rows("heading.csv").map(([t, deg]) => ({ t, kind: "heading", deg })),
  ...rows("thrusters.csv").map(([t, port, starboard]) => ({ t, kind: "pulses", port, starboard })),
].sort((a, b) => a.t - b.t);
const epoch = 1700000000; // when the log is said to have been recorded, s since 1970

// --- MAVLink -----------------------------------------------------------------------------------
const { common, minimal } = mavlink;
const radians = (deg) => ((((deg + 180) % 360) + 360) % 360 - 180) * Math.PI / 180;
function mavlinkMessages() {
  const messages = [];
  const parameters = { SERVO1_FUNCTION: 73, SERVO3_FUNCTION: 74 };
  for (const channel of [1, 3]) {
    Object.assign(parameters, { [`SERVO${channel}_MIN`]: 1100, [`SERVO${channel}_TRIM`]: 1500,
      [`SERVO${channel}_MAX`]: 1900, [`SERVO${channel}_REVERSED`]: 0 });
  }
  for (const [paramId, paramValue] of Object.entries(parameters)) {
    const m = new common.ParamValue();
    Object.assign(m, { paramId, paramValue, paramCount: 10, paramIndex: 0, paramType: 9 });
    messages.push({ t: samples[0].t, type: "PARAM_VALUE", m });
  }
  for (const s of samples) {
    if (s.kind === "fix") {
      const m = new common.GpsRawInt();
      Object.assign(m, { timeUsec: BigInt(Math.round(s.t * 1e6)), lat: Math.round(s.lat * 1e7),
        lon: Math.round(s.lon * 1e7), alt: 0, eph: 100, epv: 100, vel: 0, cog: 0, fixType: 3,
        satellitesVisible: 12 });
      messages.push({ t: s.t, type: "GPS_RAW_INT", m });
    } else if (s.kind === "heading") {
      const m = new common.Attitude();
      Object.assign(m, { timeBootMs: Math.round(s.t * 1e3), roll: 0, pitch: 0, yaw: radians(s.deg),
        rollspeed: 0, pitchspeed: 0, yawspeed: 0 });
      messages.push({ t: s.t, type: "ATTITUDE", m });
    } else {
      const m = new common.ServoOutputRaw();
      Object.assign(m, { timeUsec: Math.round(s.t * 1e6), port: 0 });
      for (let i = 1; i <= 16; ++i) m[`servo${i}Raw`] = 0;
      Object.assign(m, { servo1Raw: Math.round(s.port), servo3Raw: Math.round(s.starboard) });
      messages.push({ t: s.t, type: "SERVO_OUTPUT_RAW", m });
    }
  }
  return messages;
}

function writeTlog(path) {
  const file = openSync(path, "w");
  const v1 = new mavlink.MavLinkProtocolV1(1, 1);
  const v2 = new mavlink.MavLinkProtocolV2(1, 1);
  const other = new mavlink.MavLinkProtocolV2(42, 1);
  const signed = new mavlink.MavLinkProtocolV2(1, 1,
    mavlink.MavLinkProtocolV2.IFLAG_SIGNED);
  const key = mavlink.MavLinkPacketSignature.key("telltale");
  let n = 0;
  for (const { t, type, m } of mavlinkMessages()) {
    const stamp = Buffer.alloc(8);
    stamp.writeBigUInt64BE(BigInt(Math.round((epoch + t) * 1e6)));
    let frame;
    if (type === "PARAM_VALUE" || n % 3 === 0) frame = v2.serialize(m, n & 255);
    else if (n % 3 === 1) frame = v1.serialize(m, n & 255);
    else frame = signed.sign(signed.serialize(m, n & 255), 1, key);
    writeSync(file, stamp);
    writeSync(file, frame);
    if (n % 50 === 0) { // another vehicle and a message of no use stand between
      const heartbeat = new minimal.Heartbeat();
      Object.assign(heartbeat, { type: 11, autopilot: 3, baseMode: 0, customMode: 0,
        systemStatus: 4, mavlinkVersion: 3 });
      writeSync(file, stamp);
      writeSync(file, other.serialize(heartbeat, n & 255));
    }
    ++n;
  }
  closeSync(file);
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
async function writeBlueOs(path) {
  const { writer, end } = await mcapWriter(path, "", { useChunks: true });
  const channels = new Map();
  for (const { t, type, m } of mavlinkMessages()) {
    const topic = `mavlink/1/1/${type}`;
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
    const ns = BigInt(Math.round((epoch + t) * 1e6)) * 1000n;
    await writer.addMessage({ channelId: channels.get(topic), sequence: 0, logTime: ns,
      publishTime: ns, data: Buffer.from(JSON.stringify(
        { header: { system_id: 1, component_id: 1, sequence: 0 }, message })) });
  }
  await end();
}

const header = `std_msgs/Header header
`;
const headerDefinition = `
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
`;
const definitions = {
  "sensor_msgs/msg/NavSatFix": header + `sensor_msgs/NavSatStatus status
float64 latitude
float64 longitude
float64 altitude
float64[9] position_covariance
uint8 position_covariance_type
================================================================================
MSG: sensor_msgs/NavSatStatus
int8 status
uint16 service
` + headerDefinition,
  "sensor_msgs/msg/Imu": header + `geometry_msgs/Quaternion orientation
float64[9] orientation_covariance
geometry_msgs/Vector3 angular_velocity
float64[9] angular_velocity_covariance
geometry_msgs/Vector3 linear_acceleration
float64[9] linear_acceleration_covariance
================================================================================
MSG: geometry_msgs/Quaternion
float64 x
float64 y
float64 z
float64 w
================================================================================
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
` + headerDefinition,
  "mavros_msgs/msg/RCOut": header + `uint16[] channels
` + headerDefinition,
};

async function writeRos2(path, options) {
  const { writer, end } = await mcapWriter(path, "ros2", options);
  const topics = { fix: ["/gps/fix", "sensor_msgs/msg/NavSatFix"],
    heading: ["/imu/data", "sensor_msgs/msg/Imu"], pulses: ["/mavros/rc/out", "mavros_msgs/msg/RCOut"] };
  const writers = {};
  for (const [kind, [topic, type]] of Object.entries(topics)) {
    const schemaId = await writer.registerSchema(
      { name: type, encoding: "ros2msg", data: Buffer.from(definitions[type]) });
    writers[kind] = { serialiser: new MessageWriter(parse(definitions[type], { ros2: true })),
      channelId: await writer.registerChannel(
        { schemaId, topic, messageEncoding: "cdr", metadata: new Map() }) };
  }
  const zeros = new Array(9).fill(0);
  for (const s of samples) {
    const ns = BigInt(Math.round((epoch + s.t) * 1e6)) * 1000n;
    const stamp = { sec: Number(ns / 1000000000n), nanosec: Number(ns % 1000000000n) };
    const message = { header: { stamp, frame_id: "map" } };
    if (s.kind === "fix") {
      Object.assign(message, { status: { status: 0, service: 1 }, latitude: s.lat,
        longitude: s.lon, altitude: 0, position_covariance: zeros, position_covariance_type: 0 });
    } else if (s.kind === "heading") { // east-north-up: yaw = 90 deg - heading
      const half = (90 - s.deg) * Math.PI / 360;
      Object.assign(message, { orientation: { x: 0, y: 0, z: Math.sin(half), w: Math.cos(half) },
        orientation_covariance: zeros, angular_velocity: { x: 0, y: 0, z: 0 },
        angular_velocity_covariance: zeros, linear_acceleration: { x: 0, y: 0, z: 0 },
        linear_acceleration_covariance: zeros });
    } else {
      message.channels = [Math.round(s.port), 1500, Math.round(s.starboard), 1500];
    }
    const { serialiser, channelId } = writers[s.kind];
    await writer.addMessage({ channelId, sequence: 0, logTime: ns + 2000000n, publishTime: ns,
      data: serialiser.writeMessage(message) });
  }
  await end();
}

await zstd.isLoaded;
writeTlog(join(out, "log.tlog"));
await writeBlueOs(join(out, "blueos.mcap"));
await writeRos2(join(out, "ros2-none.mcap"), { useChunks: true });
await writeRos2(join(out, "ros2-unchunked.mcap"), { useChunks: false });
await writeRos2(join(out, "ros2-zstd.mcap"), { useChunks: true,
  compressChunk: (data) => ({ compression: "zstd",
    compressedData: zstd.compress(data, data.byteLength) }) });
await writeRos2(join(out, "ros2-lz4.mcap"), { useChunks: true,
  compressChunk: (data) => ({ compression: "lz4",
    compressedData: execFileSync("lz4", ["-q", "-c"], { input: data, maxBuffer: 1 << 28 }) }) });
