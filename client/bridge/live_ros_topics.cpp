#include "telltale/client/bridge/live_ros_topics.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "telltale/client/bridge/patience.hpp"
#include "telltale/core/base/format_number.hpp"

namespace telltale {
namespace {

constexpr double kClocksAgreeS = 1.0;
constexpr std::uint64_t kOfAnotherClock = 10;  ///< stamps in a row

// The lower the better.
constexpr int kOutputsRank = 0;
constexpr int kDriveRank = 1;
constexpr int kSidesRank = 2;
constexpr const char* kSides = "one topic each side";

}  // namespace

std::string_view Name(RosReject reason) {
  switch (reason) {
    case RosReject::kUnreadable: return "unreadable messages";
    case RosReject::kWithoutFix: return "messages without a fix or an orientation";
    case RosReject::kClockUnknown: return "before the clock was known";
    case RosReject::kOtherClock: return "on another clock";
    case RosReject::kOtherTopic: return "of topics that give way to a better one";
    case RosReject::kNotShares: return "commands that are neither shares nor pulse widths";
    case RosReject::kNotMapped: return "messages that make no sample by the mapping";
  }
  return "unknown";
}

LiveRosTopics::LiveRosTopics(const SourceOptions& options, SampleSink sink, Reject reject,
                             Report report)
    : channels_(options),
      sink_(std::move(sink)),
      reject_(std::move(reject)),
      report_(std::move(report)) {}

void LiveRosTopics::Take(std::string_view topic, std::string_view type,
                         std::span<const std::uint8_t> bytes, double arrival_s) {
  auto found = topics_.find(topic);
  if (found == topics_.end()) {
    found = topics_.emplace(std::string(topic), Topic{RosTopic(topic, type)}).first;
  }
  RosTopic& source = found->second.source;
  const std::uint64_t unreadable = source.Unreadable();
  const RosReading* const reading = source.Read(bytes);
  if (!reading) {
    return reject_(source.Unreadable() > unreadable ? RosReject::kUnreadable
                                                    : RosReject::kWithoutFix);
  }
  if (reading->position) TakePosition(*found, *reading, arrival_s);
  switch (source.Kind()) {
    case RosKind::kPosition: return;
    case RosKind::kCompass:
    case RosKind::kOrientation: return TakeHeading(*found, *reading, arrival_s);
    case RosKind::kOutputs:
    case RosKind::kDrive: return TakeCommands(*found, *reading, arrival_s);
    case RosKind::kSide: return TakeSide(*found, *reading, arrival_s);
    case RosKind::kUnknown: return;
  }
}

bool LiveRosTopics::IsChosen(Chosen& chosen, const char* channel, const std::string& topic,
                             int rank, double arrival_s) {
  if (chosen.topic != topic) {
    const bool gives_way =
        chosen.topic.empty() || rank < chosen.rank || arrival_s - chosen.heard_s > kSourcePatienceS;
    if (!gives_way) {
      reject_(RosReject::kOtherTopic);
      return false;
    }
    chosen.topic = topic;
    chosen.rank = rank;
    report_(std::string(channel) + " from " + topic);
  }
  chosen.heard_s = arrival_s;
  return true;
}

std::optional<double> LiveRosTopics::TimeOf(Topic& topic, const RosReading& reading,
                                            double arrival_s) {
  if (!begun_s_) begun_s_ = arrival_s;
  const bool disagrees = reading.stamp_s && std::abs(*reading.stamp_s - arrival_s) > kClocksAgreeS;
  topic.disagreeing = disagrees ? topic.disagreeing + 1 : 0;
  topic.ever_agreed = topic.ever_agreed || (reading.stamp_s && !disagrees);
  if (!decided_ && arrival_s - *begun_s_ < kClockPatienceS) {
    reject_(RosReject::kClockUnknown);
    return std::nullopt;
  }
  const bool stamps_counted = stamps_count_;
  if (!decided_) {
    decided_ = true;
    stamps_count_ = std::ranges::none_of(topics_, [](const Named& named) {
      return named.second.disagreeing > 0 && !named.second.ever_agreed;
    });
  } else if (topic.disagreeing >= kOfAnotherClock) {
    stamps_count_ = false;
  }
  if (stamps_counted && !stamps_count_) {
    report_("stamps are not of this computer's clock: the times of arrival count");
  }
  if (!stamps_count_ || !reading.stamp_s) return arrival_s;
  if (!disagrees) return reading.stamp_s;
  reject_(RosReject::kOtherClock);
  return std::nullopt;
}

void LiveRosTopics::TakePosition(Named& named, const RosReading& reading, double arrival_s) {
  const RosTopic& source = named.second.source;
  const bool would_jump =
      source.IsOdometry() && !positions_.topic.empty() && positions_.rank < *source.PositionRank();
  if (would_jump) return reject_(RosReject::kOtherTopic);
  if (!IsChosen(positions_, "positions", named.first, *source.PositionRank(), arrival_s)) return;
  const auto time_s = TimeOf(named.second, reading, arrival_s);
  if (time_s) sink_.fix({*time_s, reading.position->latitude_deg, reading.position->longitude_deg});
}

void LiveRosTopics::TakeHeading(Named& named, const RosReading& reading, double arrival_s) {
  const RosTopic& source = named.second.source;
  if (!IsChosen(headings_, "headings", named.first, source.Rank(), arrival_s)) return;
  const auto time_s = TimeOf(named.second, reading, arrival_s);
  if (time_s) sink_.heading({*time_s, reading.values[0]});
}

void LiveRosTopics::TakeCommands(Named& named, const RosReading& reading, double arrival_s) {
  const RosKind kind = named.second.source.Kind();
  const int rank = kind == RosKind::kOutputs ? kOutputsRank : kDriveRank;
  if (!IsChosen(commands_, "commands", named.first, rank, arrival_s)) return;
  const auto time_s = TimeOf(named.second, reading, arrival_s);
  if (!time_s) return;
  const auto commands = CommandsOf(kind, reading, channels_, *time_s);
  if (!commands) return reject_(RosReject::kUnreadable);
  sink_.command(Side::kPort, {*time_s, commands->port_us});
  sink_.command(Side::kStarboard, {*time_s, commands->starboard_us});
}

void LiveRosTopics::TakeSide(Named& named, const RosReading& reading, double arrival_s) {
  const RosTopic& source = named.second.source;
  const double value = reading.values[0];
  if (!source.IsPulse() && std::abs(value) > 1.0 && !std::exchange(named.second.is_refused, true)) {
    report_(named.first + " holds " + FormatNumber(value, 1) +
            ", neither a share of full thrust in [-1, 1] nor a pulse width: a mapping can say its "
            "unit");
  }
  if (named.second.is_refused) return reject_(RosReject::kNotShares);
  if (!IsChosen(commands_, "commands", kSides, kSidesRank, arrival_s)) return;
  Chosen& side = source.IsPort() ? port_ : starboard_;
  const char* const channel = source.IsPort() ? "port commands" : "starboard commands";
  if (!IsChosen(side, channel, named.first, 0, arrival_s)) return;
  const auto time_s = TimeOf(named.second, reading, arrival_s);
  if (!time_s) return;
  sink_.command(source.IsPort() ? Side::kPort : Side::kStarboard,
                {*time_s, source.IsPulse() ? value : PulseOfShare(value)});
}

}  // namespace telltale
