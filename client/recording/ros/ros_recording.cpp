#include "telltale/client/recording/ros/ros_recording.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "telltale/client/recording/rate_warning.hpp"
#include "telltale/client/recording/thruster_sides.hpp"
#include "telltale/core/base/median.hpp"

namespace telltale {
namespace {

constexpr double kClocksAgreeS = 1.0;

}  // namespace

void RosRecording::Take(std::string_view topic, std::string_view type, std::int64_t received_ns,
                        std::span<const std::uint8_t> bytes, CdrReader::Encoding encoding) {
  ++messages_;
  auto found = topics_.find(topic);
  if (found == topics_.end()) {
    found = topics_.emplace(std::string(topic), Topic{RosTopic(topic, type), {}}).first;
  }
  Topic& known = found->second;
  if (auto reading = known.source.Read(bytes, encoding)) {
    known.samples.push_back({1e-9 * static_cast<double>(received_ns), *std::move(reading)});
  }
}

RosRecording::RankOf RosRecording::OfKind(RosKind kind) {
  return [kind](const RosTopic& source) -> std::optional<int> {
    if (source.Kind() != kind) return std::nullopt;
    return source.Rank();
  };
}

const RosRecording::Named* RosRecording::Best(const RankOf& rank_of) const {
  const Named* best = nullptr;
  std::optional<int> best_rank;
  for (const Named& named : topics_) {
    const Topic& topic = named.second;
    const auto rank = rank_of(topic.source);
    if (!rank || topic.samples.empty()) continue;
    if (best == nullptr || rank < best_rank ||
        (rank == best_rank && topic.samples.size() > best->second.samples.size())) {
      best = &named;
      best_rank = rank;
    }
  }
  return best;
}

const RosRecording::Named* RosRecording::Side(bool is_port) const {
  for (const Named& named : topics_) {
    const RosTopic& source = named.second.source;
    if (source.Kind() == RosKind::kSide && source.IsPort() == is_port &&
        !named.second.samples.empty()) {
      return &named;
    }
  }
  return nullptr;
}

std::string RosRecording::Why(const RankOf& rank_of, const char* reason) const {
  const auto such = std::count_if(topics_.begin(), topics_.end(), [&](const Named& named) {
    return rank_of(named.second.source) && !named.second.samples.empty();
  });
  if (such < 2) return {};
  return std::string(" (") + reason + " of " + std::to_string(such) + " such topics)";
}

bool RosRecording::StampsAgree(const Named* named) const {
  if (named == nullptr) return true;
  std::vector<double> apart;
  for (const Sample& sample : named->second.samples) {
    const auto& stamp_s = sample.reading.stamp_s;
    if (stamp_s) apart.push_back(std::abs(sample.received_s - *stamp_s));
  }
  if (apart.empty()) return true;  // no stamps: the time of recording stands for them
  return Median(std::move(apart)) <= kClocksAgreeS;
}

SourceLog RosRecording::Finish(const SourceOptions& options) const {
  SourceLog log;
  std::ostringstream summary;
  summary << messages_ << (messages_ == 1 ? " message of " : " messages of ") << topics_.size()
          << (topics_.size() == 1 ? " topic" : " topics");
  const RankOf of_positions = &RosTopic::PositionRank;
  const RankOf of_compasses = OfKind(RosKind::kCompass);
  const RankOf of_orientations = OfKind(RosKind::kOrientation);
  const Named* position = Best(of_positions);
  const Named* heading = Best(of_compasses);
  if (heading == nullptr) heading = Best(of_orientations);
  const Named* outputs = Best(OfKind(RosKind::kOutputs));
  const Named* drive = Best(OfKind(RosKind::kDrive));
  const Named* port = Side(true);
  const Named* starboard = Side(false);

  const bool use_stamps = StampsAgree(position) && StampsAgree(heading) && StampsAgree(outputs);
  const auto time_of = [&](const Sample& sample) {
    return use_stamps ? sample.reading.stamp_s.value_or(sample.received_s) : sample.received_s;
  };

  if (position != nullptr) {
    summary << "; positions from " << position->first << Why(of_positions, "the best type");
    if (position->second.source.IsOdometry()) {
      summary << " (metres from an origin that is not stated, taken as "
              << kOdometryOrigin.latitude_deg << " N " << kOdometryOrigin.longitude_deg << " E)";
    }
    for (const Sample& sample : position->second.samples) {
      const GeographicPosition& at = *sample.reading.position;
      log.gnss.push_back({time_of(sample), at.latitude_deg, at.longitude_deg});
    }
  }
  if (heading != nullptr) {
    summary << "; heading from " << heading->first
            << (heading->second.source.Kind() == RosKind::kCompass
                    ? Why(of_compasses, "most samples")
                    : Why(of_orientations, "the best type"));
    if (heading->second.source.Kind() == RosKind::kOrientation) {
      summary << " (" << heading->second.source.Type() << ", "
              << (heading->second.source.IsNed() ? "north-east-down" : "east-north-up") << ")";
    }
    for (const Sample& sample : heading->second.samples) {
      log.heading.push_back({time_of(sample), sample.reading.values[0]});
    }
  }
  const RosOutputChannels channels(options);
  const auto take_commands = [&](const Named& source) {
    for (const Sample& sample : source.second.samples) {
      const auto commands =
          CommandsOf(source.second.source.Kind(), sample.reading, channels, time_of(sample));
      if (commands) log.thrusters.push_back(*commands);
    }
  };
  if (outputs != nullptr) {
    summary << "; outputs " << channels.port << " (port) and " << channels.starboard
            << " (starboard) of " << outputs->first;
    take_commands(*outputs);
  } else if (drive != nullptr) {
    summary << "; outputs from " << drive->first
            << ", shares of full thrust taken as 1500 + 400 share us";
    take_commands(*drive);
  } else if (port != nullptr && starboard != nullptr) {
    summary << "; outputs from " << port->first << " (port) and " << starboard->first
            << " (starboard)";
    double largest = 0.0;
    for (const Named* side : {port, starboard}) {
      for (const Sample& sample : side->second.samples) {
        largest = std::max(largest, std::abs(sample.reading.values[0]));
      }
    }
    const bool are_pulses = port->second.source.IsPulse() && starboard->second.source.IsPulse();
    if (!are_pulses && largest > 1.0) {
      summary << ", which hold values up to " << largest
              << ": neither shares of full thrust in [-1, 1] nor pulse widths";
    } else {
      if (!are_pulses) summary << ", shares of full thrust taken as 1500 + 400 share us";
      const auto pulse = [&](const Sample& sample) {
        return are_pulses ? sample.reading.values[0] : PulseOfShare(sample.reading.values[0]);
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
    if (named.second.source.Unreadable() > 0) {
      summary << "; " << named.second.source.Unreadable() << " unreadable messages of "
              << named.first;
    }
    if (named.second.source.WithoutFix() > 0) {
      summary << "; " << named.second.source.WithoutFix() << " positions without a fix in "
              << named.first;
    }
  }
  log.summary = summary.str();
  return log;
}

}  // namespace telltale
