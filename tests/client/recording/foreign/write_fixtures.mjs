// Writes one telemetry log in formats of other programs, by their own writers:
//
//   node write_fixtures.mjs TELEMETRY_LOG_FOLDER OUT_FOLDER
//
// OUT_FOLDER/{log.tlog, blueos.mcap, ros2-{none,lz4,zstd,unchunked}.mcap}
import { createRequire } from "node:module";
import { mkdirSync } from "node:fs";
import { join } from "node:path";
import { execFileSync } from "node:child_process";
import { Tlog, blueOsRecorder, imu, make, mavlink, mavlinkOf, navSatFix, ros2Recorder, samplesOf,
  skidSteerParameters } from "./recording_parts.mjs";

const require = createRequire(import.meta.url);
const zstd = require("@foxglove/wasm-zstd");

const [folder, out] = process.argv.slice(2);
mkdirSync(out, { recursive: true });
const samples = samplesOf(folder);
const messages = [
  ...skidSteerParameters().map((m) => ({ t: samples[0].t, m })),
  ...samples.map((s) => ({ t: s.t, m: mavlinkOf[s.kind](s) })),
];

function writeTlog(path) {
  const log = new Tlog(path);
  const v1 = new mavlink.MavLinkProtocolV1(1, 1);
  const v2 = new mavlink.MavLinkProtocolV2(1, 1);
  const other = new mavlink.MavLinkProtocolV2(42, 1);
  const signed = new mavlink.MavLinkProtocolV2(1, 1,
    mavlink.MavLinkProtocolV2.IFLAG_SIGNED);
  const key = mavlink.MavLinkPacketSignature.key("telltale");
  let n = 0;
  for (const { t, m } of messages) {
    let frame;
    if (m instanceof mavlink.common.ParamValue || n % 3 === 0) frame = v2.serialize(m, n & 255);
    else if (n % 3 === 1) frame = v1.serialize(m, n & 255);
    else frame = signed.sign(signed.serialize(m, n & 255), 1, key);
    log.put(t, frame);
    if (n % 50 === 0) { // another vehicle and a message of no use stand between
      log.put(t, other.serialize(make(mavlink.minimal.Heartbeat, { type: 11, autopilot: 3, baseMode: 0,
        customMode: 0, systemStatus: 4, mavlinkVersion: 3 }), n & 255));
    }
    ++n;
  }
  log.end();
}

async function writeBlueOs(path) {
  const { write, end } = await blueOsRecorder(path);
  for (const { t, m } of messages) await write(t, m);
  await end();
}

async function writeRos2(path, options) {
  const { write, end } = await ros2Recorder(path, options);
  const of = {
    fix: (s) => ["/gps/fix", "sensor_msgs/msg/NavSatFix", navSatFix(s)],
    heading: (s) => ["/imu/data", "sensor_msgs/msg/Imu", imu(s)],
    pulses: (s) => ["/mavros/rc/out", "mavros_msgs/msg/RCOut",
      { channels: [Math.round(s.port), 1500, Math.round(s.starboard), 1500] }],
  };
  for (const s of samples) await write(s.t + 0.002, ...of[s.kind](s), { stamp_t: s.t });
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
