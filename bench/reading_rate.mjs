// The files of reading_rate, and the readers that it is compared with:
//
//   node reading_rate.mjs make TELEMETRY_LOG_FOLDER OUT_FOLDER MEGABYTES
//   node reading_rate.mjs read FILE...
//
// make: OUT_FOLDER/messages.tlog, nothing but messages that count; mixed.tlog, one in five of which counts; a third
// as long, nothing but messages that count: messages.mcap, messages-zstd.mcap, messages-lz4.mcap, thrusts.mcap, whose
// outputs are Float64 of each thruster, and blueos.mcap, JSON of the BlueOS recorder; camera.mcap and
// camera-zstd.mcap, with a picture of 60 kB at each position. Chunks are compressed where the name says so.
// read: @mcap/core or node-mavlink on a file, messages parsed and nothing done with them.
// Run it in a folder with the packages of tests/client/recording/foreign/package.json; lz4 must be installed.
import { execFileSync } from "node:child_process";
import { createRequire } from "node:module";
import { createReadStream, mkdirSync, readFileSync, openSync, writeSync, closeSync, statSync } from "node:fs";
import { join } from "node:path";
import { randomFillSync } from "node:crypto";

const require = createRequire(join(process.cwd(), "package.json"));
const { McapWriter, McapStreamReader } = require("@mcap/core");
const mavlink = require("node-mavlink");
const zstd = require("@foxglove/wasm-zstd");
const { common } = mavlink;

const rows = (folder, name) =>
  readFileSync(join(folder, name), "utf8").trim().split("\n").slice(1).map((line) => line.split(",").map(Number));
function samplesOf(folder) {
  return [
    ...rows(folder, "gnss.csv").map(([t, lat, lon]) => ({ t, kind: "fix", lat, lon })),
    ...rows(folder, "heading.csv").map(([t, deg]) => ({ t, kind: "heading", deg })),
    ...rows(folder, "thrusters.csv").map(([t, port, starboard]) => ({ t, kind: "pulses", port, starboard })),
  ].sort((a, b) => a.t - b.t);
}

// --- MAVLink -----------------------------------------------------------------------------------
function messageOf(s, start) {
  const t = start + s.t;
  if (s.kind === "fix") {
    return Object.assign(new common.GpsRawInt(), { timeUsec: BigInt(Math.round(t * 1e6)), lat: Math.round(s.lat * 1e7),
      lon: Math.round(s.lon * 1e7), alt: 0, eph: 1, epv: 1, vel: 0, cog: 0, fixType: 3, satellitesVisible: 12 });
  }
  if (s.kind === "heading") {
    return Object.assign(new common.Attitude(), { timeBootMs: Math.round(t * 1e3), roll: 0.01, pitch: 0.01,
      yaw: s.deg * Math.PI / 180, rollspeed: 0.1, pitchspeed: 0.1, yawspeed: 0.1 });
  }
  const outputs = Object.assign(new common.ServoOutputRaw(), { timeUsec: Math.round(t * 1e6) % 4294967296, port: 0 });
  for (let i = 1; i <= 16; ++i) outputs[`servo${i}Raw`] = 0;
  return Object.assign(outputs, { servo1Raw: Math.round(s.port), servo3Raw: Math.round(s.starboard) });
}

function writeTlog(path, samples, bytes, others) {
  const file = openSync(path, "w");
  const protocol = new mavlink.MavLinkProtocolV2(1, 1);
  const frame = (m) => Buffer.concat([Buffer.from("0005faea6cd62a00", "hex"), protocol.serialize(m, 0)]);
  const parameters = ["SERVO1_FUNCTION", "SERVO3_FUNCTION"].map((paramId, i) => frame(Object.assign(
    new common.ParamValue(), { paramId, paramValue: 73 + i, paramCount: 2, paramIndex: i, paramType: 9 })));
  const other = frame(Object.assign(new common.RawImu(), { timeUsec: 1n, xacc: 1, yacc: 2, zacc: 3, xgyro: 4,
    ygyro: 5, zgyro: 6, xmag: 7, ymag: 8, zmag: 9, id: 0, temperature: 1 }));
  let written = 0;
  const put = (buffer) => { writeSync(file, buffer); written += buffer.length; };
  put(Buffer.concat(parameters));
  for (let start = 0; written < bytes; start += 700) {
    const frames = [];
    for (const s of samples) {
      frames.push(frame(messageOf(s, start)));
      for (let i = 0; i < others; ++i) frames.push(other);
    }
    put(Buffer.concat(frames));
  }
  closeSync(file);
}

function readTlog(path) { // node-mavlink takes a raw stream: the times of arrival stand between
  return new Promise((resolve, reject) => {
    const reader = mavlink.createMavLinkStream(createReadStream(path));
    let messages = 0;
    reader.on("data", (packet) => {
      const type = common.REGISTRY[packet.header.msgid];
      if (type) packet.protocol.data(packet.payload, type);
      ++messages;
    });
    reader.on("end", () => resolve(messages));
    reader.on("error", reject);
  });
}

// --- MCAP --------------------------------------------------------------------------------------
class Cdr {
  constructor() { this.view = new DataView(new ArrayBuffer(512)); this.view.setUint8(1, 1); this.at = 4; }
  put(size, set, value) {
    this.at = 4 + Math.ceil((this.at - 4) / size) * size;
    this.view[set](this.at, value, true);
    this.at += size;
    return this;
  }
  u8(v) { return this.put(1, "setUint8", v); }
  u16(v) { return this.put(2, "setUint16", v); }
  u32(v) { return this.put(4, "setUint32", v); }
  f64(v) { return this.put(8, "setFloat64", v); }
  header(ns) {
    this.u32(Number(ns / 1000000000n)).u32(Number(ns % 1000000000n)).u32(4);
    for (const c of "map\0") this.u8(c.charCodeAt(0));
    return this;
  }
  bytes() { return new Uint8Array(this.view.buffer, 0, this.at); }
}

const compressions = {
  zstd: (data) => ({ compression: "zstd", compressedData: zstd.compress(data, data.byteLength) }),
  lz4: (data) => ({ compression: "lz4",
    compressedData: execFileSync("lz4", ["-q", "-c"], { input: data, maxBuffer: 1 << 28 }) }),
};

// What the writer that `prepare` makes adds of each sample of the log, again and again, until there are so many bytes before compression.
async function writeMcap(path, profile, samples, bytes, compressChunk, prepare) {
  const file = openSync(path, "w");
  let size = 0n;
  const writable = { position: () => size,
    write: async (buffer) => { writeSync(file, buffer); size += BigInt(buffer.byteLength); } };
  const writer = new McapWriter({ writable, useChunks: true, compressChunk });
  await writer.start({ profile, library: "reading_rate" });
  const channel = async (topic, name, schema, encoding) => writer.registerChannel({ topic, messageEncoding: encoding,
    metadata: new Map(), schemaId: await writer.registerSchema({ name, encoding: schema, data: Buffer.from("") }) });
  let added = 0;
  const write = await prepare(channel, (channelId, ns, data) => {
    added += data.byteLength;
    return writer.addMessage({ channelId, sequence: 0, logTime: ns, publishTime: ns, data });
  });
  for (let start = 1000; added < bytes; start += 700) {
    for (const s of samples) {
      await write(s, start);
      if (added >= bytes) break;
    }
  }
  await writer.end();
  closeSync(file);
}

const nanoseconds = (s, start) => BigInt(Math.round((start + s.t) * 1e6)) * 1000n;

const ros2 = (pictureBytes, sides) => async (channel, add) => {
  const ros = (topic, name) => channel(topic, name, "ros2msg", "cdr");
  const channels = { fix: await ros("/gps/fix", "sensor_msgs/msg/NavSatFix"),
    heading: await ros("/imu/data", "sensor_msgs/msg/Imu") };
  if (sides) {
    channels.left = await ros("/thrusters/left/thrust", "std_msgs/msg/Float64");
    channels.right = await ros("/thrusters/right/thrust", "std_msgs/msg/Float64");
  } else {
    channels.pulses = await ros("/rc/out", "mavros_msgs/msg/RCOut");
  }
  if (pictureBytes > 0) channels.picture = await ros("/camera/compressed", "sensor_msgs/msg/CompressedImage");
  const picture = new Uint8Array(pictureBytes);
  return async (s, start) => {
    const ns = nanoseconds(s, start);
    if (s.kind === "pulses" && sides) {
      await add(channels.left, ns, new Cdr().f64((s.port - 1500) / 400).bytes());
      await add(channels.right, ns, new Cdr().f64((s.starboard - 1500) / 400).bytes());
      return;
    }
    const cdr = new Cdr().header(ns);
    if (s.kind === "fix") {
      cdr.u8(0).u16(1).f64(s.lat).f64(s.lon).f64(0);
      for (let i = 0; i < 9; ++i) cdr.f64(0);
      cdr.u8(0);
    } else if (s.kind === "heading") {
      const half = (90 - s.deg) * Math.PI / 360;
      cdr.f64(0).f64(0).f64(Math.sin(half)).f64(Math.cos(half));
      for (let i = 0; i < 33; ++i) cdr.f64(0.001 * i);
    } else {
      cdr.u32(4).u16(Math.round(s.port)).u16(1500).u16(Math.round(s.starboard)).u16(1500);
    }
    await add(channels[s.kind], ns, cdr.bytes());
    if (pictureBytes > 0 && s.kind === "fix") await add(channels.picture, ns, randomFillSync(picture));
  };
};

const types = { fix: "GPS_RAW_INT", heading: "ATTITUDE", pulses: "SERVO_OUTPUT_RAW", parameter: "PARAM_VALUE" };
const snake = (name) => name.replace(/[A-Z]/g, (c) => "_" + c.toLowerCase()).replace(/([a-z])(\d)/, "$1$2");
const blueOs = async (channel, add) => {
  const channels = {};
  for (const [kind, type] of Object.entries(types)) {
    channels[kind] = await channel(`mavlink/1/1/${type}`, type, "jsonschema", "json");
  }
  const put = (kind, ns, fields) => add(channels[kind], ns, Buffer.from(JSON.stringify(
    { header: { system_id: 1, component_id: 1, sequence: 0 }, message: { type: types[kind], ...fields } })));
  for (const [i, name] of ["SERVO1_FUNCTION", "SERVO3_FUNCTION"].entries()) {
    await put("parameter", 0n, { param_id: [...name.padEnd(16, "\0")], param_value: 73 + i });
  }
  return (s, start) => {
    const fields = Object.fromEntries(Object.entries(messageOf(s, start)).map(([key, value]) =>
      [snake(key), typeof value === "bigint" ? Number(value) : value]));
    if (s.kind === "fix") fields.fix_type = { type: "GPS_FIX_TYPE_3D_FIX" };
    return put(s.kind, nanoseconds(s, start), fields);
  };
};

async function readMcap(path) {
  const reader = new McapStreamReader({
    decompressHandlers: { zstd: (data, size) => zstd.decompress(data, Number(size)) } });
  let messages = 0;
  for await (const block of createReadStream(path, { highWaterMark: 1 << 20 })) {
    reader.append(block);
    for (let record; (record = reader.nextRecord());) messages += record.type === "Message" ? 1 : 0;
  }
  return messages;
}

await zstd.isLoaded;
const [what, ...rest] = process.argv.slice(2);
if (what === "make") {
  const [folder, out, megabytes] = rest;
  const bytes = Number(megabytes) * 1e6;
  mkdirSync(out, { recursive: true });
  const samples = samplesOf(folder);
  writeTlog(join(out, "messages.tlog"), samples, bytes, 0);
  writeTlog(join(out, "mixed.tlog"), samples, bytes, 4);
  const some = (name, profile, compressChunk, prepare) =>
    writeMcap(join(out, name), profile, samples, bytes / 3, compressChunk, prepare);
  await some("messages.mcap", "ros2", undefined, ros2(0, false));
  await some("messages-zstd.mcap", "ros2", compressions.zstd, ros2(0, false));
  await some("messages-lz4.mcap", "ros2", compressions.lz4, ros2(0, false));
  await some("thrusts.mcap", "ros2", undefined, ros2(0, true));
  await some("blueos.mcap", "", undefined, blueOs);
  for (const [name, compressChunk] of [["camera.mcap", undefined], ["camera-zstd.mcap", compressions.zstd]]) {
    await writeMcap(join(out, name), "ros2", samples, bytes, compressChunk, ros2(60000, false));
  }
} else {
  for (const path of rest) {
    const start = process.cpuUsage();
    const messages = await (path.endsWith(".mcap") ? readMcap(path) : readTlog(path));
    const used = process.cpuUsage(start);
    const seconds = (used.user + used.system) * 1e-6;
    const megabytes = statSync(path).size / 1e6;
    console.log(`${path}: ${megabytes.toFixed(0)} MB in ${seconds.toFixed(2)} s, ` +
      `${(megabytes / seconds).toFixed(0)} MB/s, ${messages} messages`);
  }
}
