// Writes one telemetry log as recordings that users have and that are odd, though nothing in them is wrong:
//
//   node write_odd_recordings.mjs TELEMETRY_LOG_FOLDER OUT_FOLDER
//
// two-gps.tlog: GPS2_RAW beside GPS_RAW_INT, the starboard side reversed, armed twice, a ground station and a
// camera that talk too; filtered-only.tlog: nothing but GLOBAL_POSITION_INT; slow-outputs.tlog: SERVO_OUTPUT_RAW at
// 2 Hz; disarmed.tlog: outputs without pulses until it is armed; clock-set.tlog: fixes on the UNIX clock, which is
// set after boot; bare.rlog: frames without times of arrival; odometry.mcap: ROS 2 with Odometry and thrusts in newtons alone; slashed-blueos.mcap: topics of
// BlueOS that begin with a slash, recorded by two components.
import { mkdirSync } from "node:fs";
import { join } from "node:path";
import { BareFrames, Tlog, attitude, blueOsRecorder, gpsRawInt, make, mavlink, mavlinkOf, nanoseconds, odometry,
  ros2Recorder, samplesOf, servoOutputRaw, skidSteerParameters } from "./recording_parts.mjs";

const { common, minimal } = mavlink;
const [folder, out] = process.argv.slice(2);
mkdirSync(out, { recursive: true });
const samples = samplesOf(folder);
const start = samples[0].t;

const autopilot = () => new mavlink.MavLinkProtocolV2(1, 1);
const heartbeat = (armed) => make(minimal.Heartbeat, { type: 11, autopilot: 3, baseMode: armed ? 209 : 81,
  customMode: 0, systemStatus: 4, mavlinkVersion: 3 });

// What `messagesOf` makes of each sample, behind the parameters.
function writeTlog(name, messagesOf, { parameters = skidSteerParameters(), Log = Tlog } = {}) {
  const log = new Log(join(out, name));
  const protocol = autopilot();
  for (const m of parameters) log.send(start, m, protocol);
  for (const s of samples) for (const m of messagesOf(s, log)) log.send(s.t, m, protocol);
  log.end();
}

{
  const station = new mavlink.MavLinkProtocolV2(255, 190);
  const camera = new mavlink.MavLinkProtocolV2(1, 100);
  const gps2 = (s) => make(common.Gps2Raw, { ...gpsRawInt(s), lat: Math.round((s.lat + 1e-5) * 1e7),
    dgpsNumch: 0, dgpsAge: 0 });
  const reversed = (s) => servoOutputRaw({ ...s, starboard: 3000 - s.starboard });
  writeTlog("two-gps.tlog", (s, log) => {
    if (s.kind === "fix") {
      log.send(s.t, make(minimal.Heartbeat, { type: 6, autopilot: 8, baseMode: 0, customMode: 0, systemStatus: 0,
        mavlinkVersion: 3 }), station);
      return [heartbeat(s.t < 40 || s.t > 50), gpsRawInt(s), gps2(s)];
    }
    if (s.kind === "heading") {
      log.send(s.t, attitude({ ...s, deg: 5 }), camera);
      return [attitude(s)];
    }
    return [reversed(s), make(common.RcChannelsRaw, { timeBootMs: Math.round(s.t * 1e3), port: 0, chan1Raw: 1500,
      chan3Raw: 1600, rssi: 100 })];
  }, { parameters: skidSteerParameters({ reversed: [3] }) });
}

{
  let deg = samples.find((s) => s.kind === "heading").deg;
  writeTlog("filtered-only.tlog", (s) => {
    if (s.kind === "heading") deg = s.deg;
    if (s.kind === "pulses") return [servoOutputRaw(s)];
    return s.kind !== "fix" ? [] : [make(common.GlobalPositionInt, { timeBootMs: Math.round(s.t * 1e3),
      lat: Math.round(s.lat * 1e7), lon: Math.round(s.lon * 1e7), alt: 0, relativeAlt: 0, vx: 0, vy: 0, vz: 0,
      hdg: Math.round(((deg + 360) % 360) * 100) % 36000 })];
  });
}

{
  let next = 0;
  writeTlog("slow-outputs.tlog", (s) => {
    if (s.kind === "pulses" && s.t < next) return [];
    if (s.kind === "pulses") next = s.t + 0.5;
    return [mavlinkOf[s.kind](s)];
  });
}

writeTlog("disarmed.tlog", (s) => {
  const isArmed = s.t >= 20;
  return s.kind !== "pulses" ? [mavlinkOf[s.kind](s)]
    : [servoOutputRaw(isArmed ? s : { ...s, port: 0, starboard: 0 }), heartbeat(isArmed)];
});

writeTlog("bare.rlog", (s) => [mavlinkOf[s.kind](s)], { Log: BareFrames });

{
  const isSet = (t) => t >= 10;
  const systemTime = (s) => make(common.SystemTime, { timeBootMs: Math.round(s.t * 1e3),
    timeUnixUsec: isSet(s.t) ? nanoseconds(s.t) / 1000n : 0n });
  writeTlog("clock-set.tlog", (s) => {
    if (s.kind !== "fix") return [mavlinkOf[s.kind](s)];
    const timeUsec = isSet(s.t) ? nanoseconds(s.t) / 1000n : BigInt(Math.round(s.t * 1e6));
    return [systemTime(s), Object.assign(gpsRawInt(s), { timeUsec })];
  });
}

{
  const metres = 111194.9; // a degree of a meridian
  const first = samples.find((s) => s.kind === "fix");
  let deg = samples.find((s) => s.kind === "heading").deg;
  const { write, end } = await ros2Recorder(join(out, "odometry.mcap"));
  for (const s of samples) {
    if (s.kind === "heading") deg = s.deg;
    if (s.kind === "fix") {
      const position = { x: (s.lon - first.lon) * metres * Math.cos(first.lat * Math.PI / 180),
        y: (s.lat - first.lat) * metres, z: 0 };
      await write(s.t, "/odometry/filtered", "nav_msgs/msg/Odometry", odometry(position, deg),
        { stamp_t: s.t, frame: "odom" });
    }
    if (s.kind === "pulses") {
      for (const [side, us] of [["left", s.port], ["right", s.starboard]]) {
        await write(s.t, `/boat/thrusters/${side}/cmd`, "std_msgs/msg/Float64", { data: 50 * (us - 1500) / 400 });
      }
    }
  }
  await end();
}

{
  const { write, end } = await blueOsRecorder(join(out, "slashed-blueos.mcap"), { topicPrefix: "/mavlink/" });
  for (const m of skidSteerParameters()) await write(start, m);
  for (const s of samples) {
    await write(s.t, mavlinkOf[s.kind](s));
    if (s.kind === "heading") await write(s.t, attitude({ ...s, deg: 5 }), { component: 154 });
    if (s.kind === "fix") await write(s.t, heartbeat(true));
  }
  await end();
}
