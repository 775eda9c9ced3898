#include "telltale/client/recording/ros/ros_recording.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "telltale/client/recording/rate_warning.hpp"
#include "telltale/client/recording/ros/cdr_reader.hpp"
#include "telltale/client/recording/thruster_sides.hpp"
#include "telltale/core/base/degrees.hpp"
#include "telltale/core/base/median.hpp"

namespace telltale {
namespace {

constexpr double kClocksAgreeS = 1.0;
constexpr int kDefaultPortChannel = 1;
constexpr int kDefaultStarboardChannel = 3;

struct RosHeader {
  double stamp_s = 0.0;
  std::string frame;
};

RosHeader ReadHeader(CdrReader& cdr) {
  if (cdr.IsRos1()) cdr.Read<std::uint32_t>();  // a sequence number
  const auto seconds = cdr.Read<std::int32_t>();
  const auto nanoseconds = cdr.Read<std::uint32_t>();
  return {seconds + 1e-9 * nanoseconds, cdr.ReadString()};
}

struct Quaternion {
  double x, y, z, w;
};

Quaternion ReadQuaternion(CdrReader& cdr) {
  Quaternion q{};
  q.x = cdr.Read<double>();
  q.y = cdr.Read<double>();
  q.z = cdr.Read<double>();
  q.w = cdr.Read<double>();
  return q;
}

double YawRad(const Quaternion& q) {
  return std::atan2(2.0 * (q.w * q.z + q.x * q.y), 1.0 - 2.0 * (q.y * q.y + q.z * q.z));
}

bool IsNull(const Quaternion& q) {
  return q.x == 0.0 && q.y == 0.0 && q.z == 0.0 && q.w == 0.0;
}

std::string Lower(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c + ('a' - 'A') : c);
  return lower;
}

bool Contains(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

bool NamesNed(const std::string& frame) {
  return Contains(Lower(frame), "ned");
}

/// -1 port, 1 starboard, 0 neither: of a topic for one thruster.
int SideOf(const std::string& topic) {
  const std::string name = Lower(topic);
  if (!Contains(name, "thrust") && !Contains(name, "propeller") && !Contains(name, "motor") &&
      !Contains(name, "pwm")) {
    return 0;
  }
  if (Contains(name, "left") || Contains(name, "port")) return -1;
  if (Contains(name, "right") || Contains(name, "starboard")) return 1;
  return 0;
}

bool IsCompassTopic(const std::string& topic) {
  const std::string name = Lower(topic);
  return name.ends_with("compass_hdg") || name.ends_with("heading");
}

}  // namespace

void RosRecording::Take(std::string_view topic, std::string_view type, std::int64_t received_ns,
                        std::span<const std::uint8_t> bytes, CdrReader::Encoding encoding) {
  ++messages_;
  auto found = topics_.find(topic);
  if (found == topics_.end()) {
    Topic fresh;
    fresh.type = std::string(type);
    const std::string name(topic);
    if (type == "sensor_msgs/msg/NavSatFix") {
      fresh.kind = Kind::kPosition;
    } else if (type == "mavros_msgs/msg/RCOut") {
      fresh.kind = Kind::kOutputs;
    } else if (type == "heron_msgs/msg/Drive") {
      fresh.kind = Kind::kDrive;
    } else if (type == "std_msgs/msg/Float64" && IsCompassTopic(name)) {
      fresh.kind = Kind::kCompass;
    } else if (type == "sensor_msgs/msg/Imu" || type == "geometry_msgs/msg/QuaternionStamped" ||
               type == "nav_msgs/msg/Odometry") {
      fresh.kind = Kind::kOrientation;
      fresh.rank = type == "sensor_msgs/msg/Imu" ? 1 : type == "nav_msgs/msg/Odometry" ? 3 : 2;
    } else if ((type == "std_msgs/msg/Float64" || type == "std_msgs/msg/Float32" ||
                type == "std_msgs/msg/UInt16") &&
               SideOf(name) != 0) {
      fresh.kind = Kind::kSide;
      fresh.is_pulse = type == "std_msgs/msg/UInt16";
    }
    found = topics_.emplace(name, std::move(fresh)).first;
  }
  Topic& known = found->second;
  if (known.kind == Kind::kUnknown) return;

  CdrReader cdr(bytes, encoding);
  Sample sample;
  sample.received_s = 1e-9 * static_cast<double>(received_ns);
  bool is_usable = true;
  const auto stamp = [&](const RosHeader& header) {
    if (header.stamp_s != 0.0) sample.stamp_s = header.stamp_s;
    known.is_ned = known.is_ned || NamesNed(header.frame);
  };
  switch (known.kind) {
    case Kind::kPosition: {
      stamp(ReadHeader(cdr));
      const auto status = cdr.Read<std::int8_t>();
      cdr.Read<std::uint16_t>();
      sample.values[0] = cdr.Read<double>();
      sample.values[1] = cdr.Read<double>();
      if (status < 0) {
        ++known.without_fix;
        is_usable = false;
      }
      break;
    }
    case Kind::kCompass: sample.values[0] = cdr.Read<double>(); break;
    case Kind::kOrientation: {
      stamp(ReadHeader(cdr));
      if (known.type == "nav_msgs/msg/Odometry") {
        cdr.ReadString();
        for (int i = 0; i < 3; ++i) cdr.Read<double>();
      }
      const Quaternion q = ReadQuaternion(cdr);
      const double yaw_deg = YawRad(q) * kDegreesPerRadian;
      sample.values[0] = known.is_ned ? yaw_deg : 90.0 - yaw_deg;
      is_usable = !IsNull(q);
      if (known.type == "sensor_msgs/msg/Imu" && cdr.Read<double>() == -1.0) is_usable = false;
      break;
    }
    case Kind::kOutputs:
      stamp(ReadHeader(cdr));
      sample.outputs = cdr.ReadSequence<std::uint16_t>();
      break;
    case Kind::kDrive:
      sample.values[0] = static_cast<double>(cdr.Read<float>());
      sample.values[1] = static_cast<double>(cdr.Read<float>());
      break;
    case Kind::kSide:
      sample.values[0] = known.type == "std_msgs/msg/UInt16" ? cdr.Read<std::uint16_t>()
                         : known.type == "std_msgs/msg/Float32"
                             ? static_cast<double>(cdr.Read<float>())
                             : cdr.Read<double>();
      break;
    case Kind::kUnknown: break;
  }
  if (!cdr.Ok()) {
    ++known.unreadable;
  } else if (is_usable) {
    known.samples.push_back(std::move(sample));
  }
}

const RosRecording::Named* RosRecording::Best(Kind kind) const {
  const Named* best = nullptr;
  for (const Named& named : topics_) {
    const Topic& topic = named.second;
    if (topic.kind != kind || topic.samples.empty()) continue;
    if (best == nullptr || topic.rank < best->second.rank ||
        (topic.rank == best->second.rank && topic.samples.size() > best->second.samples.size())) {
      best = &named;
    }
  }
  return best;
}

const RosRecording::Named* RosRecording::Side(bool is_port) const {
  for (const Named& named : topics_) {
    if (named.second.kind == Kind::kSide && !named.second.samples.empty() &&
        SideOf(named.first) == (is_port ? -1 : 1)) {
      return &named;
    }
  }
  return nullptr;
}

std::string RosRecording::Why(Kind kind, const char* reason) const {
  const auto such = std::count_if(topics_.begin(), topics_.end(), [&](const Named& named) {
    return named.second.kind == kind && !named.second.samples.empty();
  });
  if (such < 2) return {};
  return std::string(" (") + reason + " of " + std::to_string(such) + " such topics)";
}

bool RosRecording::StampsAgree(const Named* named) const {
  if (named == nullptr) return true;
  std::vector<double> apart;
  for (const Sample& sample : named->second.samples) {
    if (sample.stamp_s) apart.push_back(std::abs(sample.received_s - *sample.stamp_s));
  }
  if (apart.empty()) return true;  // no stamps: the time of recording stands for them
  return Median(std::move(apart)) <= kClocksAgreeS;
}

SourceLog RosRecording::Finish(const SourceOptions& options) const {
  SourceLog log;
  std::ostringstream summary;
  summary << messages_ << (messages_ == 1 ? " message of " : " messages of ") << topics_.size()
          << (topics_.size() == 1 ? " topic" : " topics");
  const Named* position = Best(Kind::kPosition);
  const Named* heading = Best(Kind::kCompass);
  if (heading == nullptr) heading = Best(Kind::kOrientation);
  const Named* outputs = Best(Kind::kOutputs);
  const Named* drive = Best(Kind::kDrive);
  const Named* port = Side(true);
  const Named* starboard = Side(false);

  const bool use_stamps = StampsAgree(position) && StampsAgree(heading) && StampsAgree(outputs);
  const auto time_of = [&](const Sample& sample) {
    return use_stamps ? sample.stamp_s.value_or(sample.received_s) : sample.received_s;
  };

  if (position != nullptr) {
    summary << "; positions from " << position->first << Why(Kind::kPosition, "most fixes");
    for (const Sample& sample : position->second.samples) {
      log.gnss.push_back({time_of(sample), sample.values[0], sample.values[1]});
    }
  }
  if (heading != nullptr) {
    summary << "; heading from " << heading->first
            << (heading->second.kind == Kind::kCompass ? Why(Kind::kCompass, "most samples")
                                                       : Why(Kind::kOrientation, "the best type"));
    if (heading->second.kind == Kind::kOrientation) {
      summary << " (" << heading->second.type << ", "
              << (heading->second.is_ned ? "north-east-down" : "east-north-up") << ")";
    }
    for (const Sample& sample : heading->second.samples) {
      log.heading.push_back({time_of(sample), sample.values[0]});
    }
  }
  if (outputs != nullptr) {
    const int port_channel = options.port_channel.value_or(kDefaultPortChannel);
    const int starboard_channel = options.starboard_channel.value_or(kDefaultStarboardChannel);
    summary << "; outputs " << port_channel << " (port) and " << starboard_channel
            << " (starboard) of " << outputs->first;
    const auto most = static_cast<std::size_t>(std::max(port_channel, starboard_channel));
    for (const Sample& sample : outputs->second.samples) {
      if (sample.outputs.size() < most) continue;
      log.thrusters.push_back(
          {time_of(sample),
           static_cast<double>(sample.outputs[static_cast<std::size_t>(port_channel - 1)]),
           static_cast<double>(sample.outputs[static_cast<std::size_t>(starboard_channel - 1)])});
    }
  } else if (drive != nullptr) {
    summary << "; outputs from " << drive->first
            << ", shares of full thrust taken as 1500 + 400 share us";
    for (const Sample& sample : drive->second.samples) {
      log.thrusters.push_back(
          {time_of(sample), PulseOfShare(sample.values[0]), PulseOfShare(sample.values[1])});
    }
  } else if (port != nullptr && starboard != nullptr) {
    summary << "; outputs from " << port->first << " (port) and " << starboard->first
            << " (starboard)";
    double largest = 0.0;
    for (const Named* side : {port, starboard}) {
      for (const Sample& sample : side->second.samples) {
        largest = std::max(largest, std::abs(sample.values[0]));
      }
    }
    const bool are_pulses = port->second.is_pulse && starboard->second.is_pulse;
    if (!are_pulses && largest > 1.0) {
      summary << ", which hold values up to " << largest
              << ": neither shares of full thrust in [-1, 1] nor pulse widths";
    } else {
      if (!are_pulses) summary << ", shares of full thrust taken as 1500 + 400 share us";
      const auto pulse = [&](const Sample& sample) {
        return are_pulses ? sample.values[0] : PulseOfShare(sample.values[0]);
      };
      const auto commands = [&](const Named& side) {
        std::vector<SideCommand> told;
        for (const Sample& sample : side.second.samples) {
          told.push_back({sample.received_s, pulse(sample)});
        }
        return told;
      };
      log.thrusters = JoinSides(commands(*port), commands(*starboard));
    }
  }
  if (outputs != nullptr) {
    summary << RateWarning(outputs->first, log.thrusters, kLowOutputHz,
                           "set SR0_RC_CHAN of the autopilot to 10, or ask for message 36 by the "
                           "service set_message_interval of MAVROS");
  }
  if (position != nullptr) {
    summary << RateWarning(position->first, log.gnss, kLowPositionHz,
                           "set the receiver to 5 Hz or more");
  }
  if (heading != nullptr) {
    summary << RateWarning(heading->first, log.heading, kLowHeadingHz,
                           "publish it at 10 Hz or more");
  }
  summary << "; times " << (use_stamps ? "of the messages' headers" : "of recording");
  for (const Named& named : topics_) {
    if (named.second.unreadable > 0) {
      summary << "; " << named.second.unreadable << " unreadable messages of " << named.first;
    }
    if (named.second.without_fix > 0) {
      summary << "; " << named.second.without_fix << " positions without a fix in " << named.first;
    }
  }
  log.summary = summary.str();
  return log;
}

}  // namespace telltale
