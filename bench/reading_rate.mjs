// The files of reading_rate, and the readers that it is compared with:
//
//   node reading_rate.mjs make TELEMETRY_LOG_FOLDER OUT_FOLDER MEGABYTES
//   node reading_rate.mjs read FILE...
//
// make: OUT_FOLDER/messages.tlog, nothing but messages that count; mixed.tlog, one in five of which counts;
// messages.mcap, a third as long, nothing but messages that count; camera.mcap, with a picture of 60 kB at each
// position. Chunks are not compressed.
// read: @mcap/core or node-mavlink on a file, messages parsed and nothing done with them.
// Run it in a folder with the packages of tests/client/recording/foreign/package.json.
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

async function writeMcap(path, samples, bytes, pictureBytes) {
  const file = openSync(path, "w");
  let size = 0n;
  const writable = { position: () => size,
    write: async (buffer) => { writeSync(file, buffer); size += BigInt(buffer.byteLength); } };
  const writer = new McapWriter({ writable, useChunks: true });
  await writer.start({ profile: "ros2", library: "reading_rate" });
  const channel = async (topic, name) => writer.registerChannel({ topic, messageEncoding: "cdr",
    metadata: new Map(), schemaId: await writer.registerSchema({ name, encoding: "ros2msg", data: Buffer.from("") }) });
  const channels = { fix: await channel("/gps/fix", "sensor_msgs/msg/NavSatFix"),
    heading: await channel("/imu/data", "sensor_msgs/msg/Imu"),
    pulses: await channel("/rc/out", "mavros_msgs/msg/RCOut"),
    picture: await channel("/camera/compressed", "sensor_msgs/msg/CompressedImage") };
  const picture = randomFillSync(new Uint8Array(pictureBytes));
  for (let start = 1000; size < bytes; start += 700) {
    for (const s of samples) {
      const ns = BigInt(Math.round((start + s.t) * 1e6)) * 1000n;
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
      const add = (channelId, data) => writer.addMessage({ channelId, sequence: 0, logTime: ns, publishTime: ns, data });
      await add(channels[s.kind], cdr.bytes());
      if (pictureBytes > 0 && s.kind === "fix") await add(channels.picture, picture);
      if (size >= bytes) break;
    }
  }
  await writer.end();
  closeSync(file);
}

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
  await writeMcap(join(out, "messages.mcap"), samples, bytes / 3, 0);
  await writeMcap(join(out, "camera.mcap"), samples, bytes, 60000);
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
