// Writes one telemetry log as the systems of deploy/mappings record it with ros2 bag:
//
//   node write_systems.mjs TELEMETRY_LOG_FOLDER OUT_FOLDER
//
// OUT_FOLDER/{mavros,ardupilot,vrx}.mcap. Names, types, units and frames are those that MAVROS 2, AP_DDS of
// ArduPilot 4.5 and VRX 2 publish, with neighbours that must not be taken for what is sought.
import { mkdirSync } from "node:fs";
import { join } from "node:path";
import { imu, navSatFix, odometry, orientation, ros2Recorder, samplesOf, zeros } from "./recording_parts.mjs";

const [folder, out] = process.argv.slice(2);
mkdirSync(out, { recursive: true });
const samples = samplesOf(folder);
const point = { x: 1, y: 2, z: 3 };
const late_s = 0.003; // of a stamp before its recording

// Two boats. The second is elsewhere, and its messages are recorded first.
const other = { fix: (s) => ({ ...s, lat: s.lat + 0.01, lon: s.lon + 0.01 }),
  heading: (s) => ({ ...s, deg: s.deg + 90 }), pulses: (s) => ({ ...s, port: s.starboard, starboard: s.port }) };
async function writeMavros(path) {
  const { write, end } = await ros2Recorder(path);
  const ofBoat = async (s, boat) => {
    const put = (topic, type, message, frame) => write(s.t, `/${boat}/mavros/${topic}`, type, message,
      frame === undefined ? {} : { stamp_t: s.t - late_s, frame });
    if (s.kind === "fix") {
      await put("global_position/global", "sensor_msgs/msg/NavSatFix",
        navSatFix({ ...s, lat: s.lat + 1e-6 }), "base_link");
      await put("global_position/raw/fix", "sensor_msgs/msg/NavSatFix", navSatFix(s), "base_link");
      await put("global_position/local", "nav_msgs/msg/Odometry", odometry(point, 10), "map");
    } else if (s.kind === "heading") {
      await put("imu/data", "sensor_msgs/msg/Imu", imu({ ...s, deg: s.deg + 0.5 }), "base_link");
      await put("global_position/compass_hdg", "std_msgs/msg/Float64", { data: (s.deg + 360) % 360 });
      await put("global_position/rel_alt", "std_msgs/msg/Float64", { data: 0.4 });
    } else {
      const channels = zeros(16);
      channels[0] = Math.round(s.port);
      channels[2] = Math.round(s.starboard);
      await put("rc/in", "mavros_msgs/msg/RCIn", { rssi: 100, channels: [1500, 1501, 1502, 1503] }, "");
      await put("rc/override", "mavros_msgs/msg/OverrideRCIn", { channels: new Array(18).fill(1600) });
      await put("rc/out", "mavros_msgs/msg/RCOut", { channels }, "");
    }
  };
  const seen = new Set();
  for (const s of samples) {
    const boats = [() => ofBoat(s, "usv1"), () => ofBoat(other[s.kind](s), "usv2")];
    // The first fix is one of usv1, the first heading and the first outputs are of usv2.
    if (!seen.has(s.kind) && s.kind !== "fix") boats.reverse();
    seen.add(s.kind);
    for (const boat of boats) await boat();
  }
  await end();
}

async function writeArduPilot(path) {
  const { write, end } = await ros2Recorder(path);
  for (const s of samples) {
    const stamp = { stamp_t: s.t - late_s };
    if (s.kind === "fix") {
      await write(s.t, "/ap/navsat", "sensor_msgs/msg/NavSatFix", navSatFix(s), { ...stamp, frame: "0" });
    } else if (s.kind === "heading") {
      const pose = orientation(s.deg);
      await write(s.t, "/ap/pose/filtered", "geometry_msgs/msg/PoseStamped",
        { pose: { position: point, orientation: orientation(s.deg + 0.5) } }, { ...stamp, frame: "base_link" });
      await write(s.t, "/ap/geopose/filtered", "geographic_msgs/msg/GeoPoseStamped",
        { pose: { position: { latitude: 37, longitude: -6, altitude: 0 }, orientation: pose } },
        { ...stamp, frame: "base_link" });
    } else {
      await write(s.t, "/mavros/rc/out", "mavros_msgs/msg/RCOut",
        { channels: [Math.round(s.port), 1500, Math.round(s.starboard), 1500] }, { ...stamp, frame: "" });
    }
  }
  await end();
}

const newtons = (us) => 1000 * (us - 1500) / 400; // deploy/mappings/vrx.textproto
async function writeVrx(path) {
  const { write, end } = await ros2Recorder(path);
  for (const s of samples) {
    const stamp = { stamp_t: s.t - late_s };
    if (s.kind === "fix") {
      await write(s.t, "/wamv/ground_truth/odometry", "nav_msgs/msg/Odometry", odometry(point, 10),
        { ...stamp, frame: "world" });
      await write(s.t, "/wamv/sensors/gps/gps/fix", "sensor_msgs/msg/NavSatFix", navSatFix(s),
        { ...stamp, frame: "wamv/wamv/gps_wamv_link/navsat" });
    } else if (s.kind === "heading") {
      await write(s.t, "/wamv/sensors/imu/imu/data", "sensor_msgs/msg/Imu", imu(s),
        { ...stamp, frame: "wamv/wamv/imu_wamv_link/imu_wamv_sensor" });
    } else {
      for (const [side, us] of [["left", s.port], ["right", s.starboard]]) {
        await write(s.t, `/wamv/thrusters/${side}/pos`, "std_msgs/msg/Float64", { data: 0.1 });
        await write(s.t, `/wamv/thrusters/${side}/thrust`, "std_msgs/msg/Float64", { data: newtons(us) });
      }
    }
  }
  await end();
}

await writeMavros(join(out, "mavros.mcap"));
await writeArduPilot(join(out, "ardupilot.mcap"));
await writeVrx(join(out, "vrx.mcap"));
