// Plays autopilots that send MAVLink, by a writer that is not the project's:
//
//   node send_live.mjs PORT|tcp:PORT VEHICLES SECONDS LOSS_EVERY SPEED [DENIED]
//
// They send to a UDP port of this machine, or to whoever connects to a TCP port. They accept the intervals
// they are asked for, but for that of message DENIED.
// Systems 1 to VEHICLES send heartbeats, their clock, their parameters and a sample of each channel, at
// times before 10 s, until SIGUSR2 comes. Then come SECONDS of data from 10 s on, at SPEED times real time,
// of which each frame LOSS_EVERY (0: none) is left out. Frames are of version 1, 2 and signed in turn, with
// garbage between. Prints what each system is asked for, and at the end what each sent from 10 s on, `lost`,
// the frames left out, and `asked`, the messages whose intervals were asked for.
import { createRequire } from "node:module";
import { createSocket } from "node:dgram";
import { createServer } from "node:net";

const require = createRequire(import.meta.url);
const mavlink = require("node-mavlink");
const { common, minimal } = mavlink;
const place = process.argv[2];
const [vehicles, seconds, lossEvery, speed, denied = 0] = process.argv.slice(3).map(Number);
const unixUs = 1700000000000000n; // UTC of boot
const key = mavlink.MavLinkPacketSignature.key("telltale");
const made = (Message, fields) => Object.assign(new Message(), fields);

// Ways to the listener: a socket a vehicle, where each datagram is a frame or garbage; or one stream for
// all, in which garbage would swallow the frame after it.
function openDatagrams(port) {
  const socket = createSocket("udp4");
  return { send: (bytes) => socket.send(bytes, port, "127.0.0.1"),
    listen: (answer) => socket.on("message", answer), takesGarbage: true };
}
function openStream(port) {
  let listener = null;
  const answers = [];
  createServer((socket) => {
    listener = socket;
    socket.on("error", () => {});
    socket.on("data", (bytes) => framesOf(bytes).forEach((frame) => answers.forEach((one) => one(frame))));
  }).listen(port, "127.0.0.1", () => console.log("ready"));
  return { send: (bytes) => listener?.write(bytes), listen: (answer) => answers.push(answer), takesGarbage: false };
}
// Frames that a stream brought together; what it cut is left out.
function framesOf(bytes) {
  const frames = [];
  for (let at = 0; at + 1 < bytes.length;) {
    const size = bytes[at + 1] + (bytes[at] === 0xfd ? 12 : 8);
    frames.push(bytes.subarray(at, at + size));
    at += size;
  }
  return frames.filter((frame) => frame.length >= 8);
}
const stream = place.startsWith("tcp:") ? openStream(Number(place.slice(4))) : null;

class Autopilot {
  constructor(system) {
    this.system = system;
    this.way = stream ?? openDatagrams(Number(place));
    this.asked = new Set();
    this.way.listen((bytes) => this.answer(bytes));
    this.v1 = new mavlink.MavLinkProtocolV1(system, 1);
    this.v2 = new mavlink.MavLinkProtocolV2(system, 1);
    this.signed = new mavlink.MavLinkProtocolV2(system, 1, mavlink.MavLinkProtocolV2.IFLAG_SIGNED);
    this.sequence = 0;
    this.sent = { system, gnss: [], heading: [], thrusters: [], lost: 0, asked: [] };
  }
  // What the bridge asks for: MAV_CMD_SET_MESSAGE_INTERVAL in a COMMAND_LONG of version 1 or 2.
  // Version 2 cuts zeros, which a target component of 1 ends.
  answer(bytes) {
    const isV2 = bytes[0] === 0xfd;
    const id = isV2 ? bytes.readUIntLE(7, 3) : bytes[5];
    const at = isV2 ? 10 : 6;
    if (id !== 76 || bytes.readUInt16LE(at + 28) !== 511 || bytes[at + 30] !== this.system) return;
    const message = bytes.readFloatLE(at);
    if (!this.asked.has(message)) console.log(`system ${this.system} is asked for ${message}`);
    this.asked.add(message);
    this.send(made(common.CommandAck, { command: 511, result: message === denied ? 2 : 0, progress: 0,
      resultParam2: 0, targetSystem: 254, targetComponent: 191 }));
  }
  send(message, lossy = false) {
    const n = this.sequence++;
    const wantsV2 = message.constructor.MSG_NAME === "PARAM_VALUE" || n % 3 === 0;
    const frame = wantsV2 ? this.v2.serialize(message, n & 255)
      : n % 3 === 1 ? this.v1.serialize(message, n & 255)
      : this.signed.sign(this.signed.serialize(message, n & 255), 1, key);
    if (lossy && lossEvery > 0 && n % lossEvery === 0) {
      ++this.sent.lost;
      return false;
    }
    this.way.send(frame);
    if (n % 40 === 0 && this.way.takesGarbage) this.way.send(Buffer.from([0xfd, 0x09, 0x00, 0x55, 0xfe, 0x21]));
    return true;
  }
  introduce(ms) {
    this.send(made(minimal.Heartbeat, { type: 11, autopilot: 3, baseMode: 0, customMode: 0,
      systemStatus: 4, mavlinkVersion: 3 }));
    this.send(made(common.SystemTime, { timeUnixUsec: unixUs + BigInt(ms) * 1000n, timeBootMs: ms }));
    for (const [paramId, paramValue] of [["SERVO1_FUNCTION", 73], ["SERVO3_FUNCTION", 74]]) {
      this.send(made(common.ParamValue, { paramId, paramValue, paramCount: 2, paramIndex: 0, paramType: 9 }));
    }
  }
  data(ms, i, lossy) {
    const lat = 634000000 + 1000 * this.system + i, lon = 104000000 - i;
    const yaw = Math.fround(Math.sin(i / 30));
    const pulses = made(common.ServoOutputRaw, { timeUsec: ms * 1000, port: 0 });
    for (let k = 1; k <= 16; ++k) pulses[`servo${k}Raw`] = 0;
    Object.assign(pulses, { servo1Raw: 1500 + i % 300, servo3Raw: 1500 - i % 300 });
    const channels = {
      heading: [made(common.Attitude, { timeBootMs: ms, roll: 0, pitch: 0, yaw, rollspeed: 0, pitchspeed: 0,
        yawspeed: 0 }), [ms, yaw]],
      gnss: [made(common.GpsRawInt, { timeUsec: BigInt(ms) * 1000n, lat, lon, alt: 0, eph: 100, epv: 100,
        vel: 0, cog: 0, fixType: 3, satellitesVisible: 12 }), [ms, lat, lon]],
      thrusters: [pulses, [ms, pulses.servo1Raw, pulses.servo3Raw]],
    };
    for (const [channel, [message, values]] of Object.entries(channels)) {
      if (this.send(message, lossy) && lossy) this.sent[channel].push(values);
    }
  }
}

const autopilots = Array.from({ length: vehicles }, (_, i) => new Autopilot(i + 1));
let rounds = 0;
const hello = setInterval(() => {
  for (const one of autopilots) {
    one.introduce(9000 + rounds);
    one.data(9000 + rounds, 0, false);
  }
  ++rounds;
}, 100);
process.once("SIGUSR2", () => {
  clearInterval(hello);
  let i = 0;
  const data = setInterval(() => {
    const ms = 10000 + 100 * i;
    if (i < 10 * seconds) {
      for (const one of autopilots) one.data(ms, i, true);
      ++i;
      return;
    }
    clearInterval(data);
    for (const one of autopilots) {
      one.introduce(ms); // arrives, so that the last loss is seen
      one.sent.asked = [...one.asked].sort((a, b) => a - b);
    }
    console.log(JSON.stringify(autopilots.map((one) => one.sent)));
    setTimeout(() => process.exit(0), 200); // once all is on its way
  }, 100 / speed);
});
if (stream === null) console.log("ready");
