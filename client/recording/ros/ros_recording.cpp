#include "telltale/client/recording/ros/ros_recording.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <tuple>

#include "telltale/client/recording/further_part.hpp"
#include "telltale/client/recording/rate_warning.hpp"
#include "telltale/core/base/median.hpp"

namespace telltale {
namespace {

constexpr double kClocksAgreeS = 1.0;

template <class Sample>
void SetTimes(std::vector<Sample>& samples, const std::vector<double>& times_s) {
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i].time_s = times_s[i];
}

/// How many names of two topics' paths are the same, from the first on.
std::size_t SharedNames(std::string_view a, std::string_view b) {
  const auto [end, ignored] = std::ranges::mismatch(a, b);
  return static_cast<std::size_t>(std::count(a.begin(), end, '/'));
}

double LargestOf(const std::vector<SideCommand>& told) {
  double largest = 0.0;
  for (const SideCommand& command : told) largest = std::max(largest, std::abs(command.pulse_us));
  return largest;
}

void MakePulses(std::vector<SideCommand>& shares) {
  for (SideCommand& share : shares) share.pulse_us = PulseOfShare(share.pulse_us);
}

}  // namespace

// ---- one topic ----------------------------------------------------------------------------------

void RosRecording::Topic::Take(double at_s, const RosReading& reading,
                               const RosOutputChannels& channels) {
  if (!HasPlaceFor(at_s)) return;
  const double time_s = reading.stamp_s.value_or(at_s);
  if (reading.position) {
    AddRow(fixes, {time_s, reading.position->latitude_deg, reading.position->longitude_deg});
  }
  switch (source.Kind()) {
    case RosKind::kCompass:
    case RosKind::kOrientation: AddRow(headings, {time_s, reading.values[0]}); break;
    case RosKind::kOutputs:
    case RosKind::kDrive: {
      const auto command = CommandsOf(source.Kind(), reading, channels, time_s);
      if (!command) {
        ++without_channels;
        return;
      }
      AddRow(commands, *command);
      break;
    }
    case RosKind::kSide: AddRow(told, {time_s, reading.values[0]}); break;
    case RosKind::kPosition:
    case RosKind::kUnknown: break;
  }
  AddRow(received_s, at_s);
  Added(BytesOfRow());
}

std::size_t RosRecording::Topic::BytesOfRow() const {
  return sizeof(double) + (fixes.empty() ? 0 : sizeof(GnssFix)) +
         (headings.empty() ? 0 : sizeof(HeadingSample)) +
         (commands.empty() ? 0 : sizeof(ThrusterSample)) + (told.empty() ? 0 : sizeof(SideCommand));
}

void RosRecording::Topic::KeepOnly(const std::vector<bool>& is_kept) {
  KeepRows(received_s, is_kept);
  KeepRows(fixes, is_kept);
  KeepRows(headings, is_kept);
  KeepRows(commands, is_kept);
  KeepRows(told, is_kept);
}

double RosRecording::Topic::StampOf(std::size_t i) const {
  if (!fixes.empty()) return fixes[i].time_s;
  if (!headings.empty()) return headings[i].time_s;
  if (!commands.empty()) return commands[i].time_s;
  return told[i].time_s;
}

bool RosRecording::Topic::StampsAgree() const {
  std::vector<double> apart_s;
  const std::size_t step = 1 + received_s.size() / kEnoughPeriods;
  for (std::size_t i = 0; i < received_s.size(); i += step) {
    // Without a header the time of recording stands for it.
    if (received_s[i] != StampOf(i)) apart_s.push_back(std::abs(received_s[i] - StampOf(i)));
  }
  return apart_s.empty() || Median(std::move(apart_s)) <= kClocksAgreeS;
}

void RosRecording::Topic::TimeByRecording() {
  SetTimes(fixes, received_s);
  SetTimes(headings, received_s);
  SetTimes(commands, received_s);
}

// ---- the choice among topics --------------------------------------------------------------------

MessageTaker RosRecording::Open(const RosChannel& channel, CdrReader::Encoding encoding) {
  RosTopic source(channel.topic, channel.type);
  if (source.Kind() == RosKind::kUnknown) return nullptr;
  Topic& topic =
      topics_.try_emplace(std::string(channel.topic), memory_, std::move(source)).first->second;
  return [this, &topic, encoding](std::int64_t received_ns, std::span<const std::uint8_t> message) {
    ++topic.messages;
    if (const RosReading* const reading = topic.source.Read(message, encoding)) {
      topic.Take(1e-9 * static_cast<double>(received_ns), *reading, channels_);
    }
  };
}

RosRecording::RankOf RosRecording::OfKind(RosKind kind) {
  return [kind](const RosTopic& source) -> std::optional<int> {
    if (source.Kind() != kind) return std::nullopt;
    return source.Rank();
  };
}

RosRecording::RankOf RosRecording::OfSide(bool is_port) {
  return [is_port](const RosTopic& source) -> std::optional<int> {
    if (source.Kind() != RosKind::kSide || source.IsPort() != is_port) return std::nullopt;
    return source.Rank();
  };
}

RosRecording::Named* RosRecording::Best(const RankOf& rank_of, std::string_view beside) {
  Named* best = nullptr;
  std::tuple<int, std::size_t, std::size_t> best_place;  // the larger the better
  for (Named& named : topics_) {
    const Topic& topic = named.second;
    const auto rank = rank_of(topic.source);
    if (!rank || topic.IsEmpty()) continue;
    const std::tuple place(-*rank, SharedNames(named.first, beside), topic.received_s.size());
    if (best == nullptr || place > best_place) {
      best = &named;
      best_place = place;
    }
  }
  return best;
}

std::string RosRecording::Why(const RankOf& rank_of, const char* reason) const {
  const auto such = std::count_if(topics_.begin(), topics_.end(), [&](const Named& named) {
    return rank_of(named.second.source) && !named.second.IsEmpty();
  });
  if (such < 2) return {};
  return std::string(" (") + reason + " of " + std::to_string(such) + " such topics)";
}

// ---- the channels -------------------------------------------------------------------------------

// Each fills a channel and says from what.

std::string RosRecording::TakePositions(Named& from, SourceLog& log) const {
  std::ostringstream said;
  said << "; positions from " << from.first << Why(&RosTopic::PositionRank, "the best type");
  if (from.second.source.IsOdometry()) {
    said << " (metres from " << OdometryOriginText() << ')';
  }
  log.gnss = std::move(from.second.fixes);
  return said.str();
}

std::string RosRecording::TakeHeadings(Named& from, SourceLog& log) const {
  const RosTopic& source = from.second.source;
  std::string said = "; heading from " + from.first;
  said += source.Kind() == RosKind::kCompass ? Why(OfKind(RosKind::kCompass), "most samples")
                                             : Why(OfKind(RosKind::kOrientation), "the best type");
  if (source.Kind() == RosKind::kOrientation) {
    said += " (" + source.Type() + (source.IsNed() ? ", north-east-down)" : ", east-north-up)");
  }
  log.heading = std::move(from.second.headings);
  return said;
}

std::string RosRecording::TakeSides(Named& port, Named& starboard, SourceLog& log) const {
  std::ostringstream said;
  said << "; outputs from " << port.first << " (port) and " << starboard.first << " (starboard)";
  auto& of_port = port.second.told;
  auto& of_starboard = starboard.second.told;
  if (!port.second.source.IsPulse() || !starboard.second.source.IsPulse()) {
    const double largest = std::max(LargestOf(of_port), LargestOf(of_starboard));
    if (largest > 1.0) {
      said << ", which hold values up to " << largest
           << ": neither shares of full thrust in [-1, 1] nor pulse widths. If they are newtons, a "
              "mapping such as deploy/mappings/vrx.textproto says with unit: \"N\" which are full "
              "thrust";
      return said.str();
    }
    said << ", shares of full thrust taken as 1500 + 400 share us";
    MakePulses(of_port);
    MakePulses(of_starboard);
  }
  log.thrusters = JoinSides(of_port, of_starboard);
  return said.str();
}

std::string RosRecording::Faults() const {
  std::ostringstream said;
  for (const auto& [name, topic] : topics_) {
    if (topic.source.Unreadable() > 0) {
      said << "; " << topic.source.Unreadable() << " unreadable messages of " << name;
    }
    if (topic.source.WithoutFix() > 0) {
      said << "; " << topic.source.WithoutFix() << " positions without a fix in " << name;
    }
    if (topic.without_channels > 0) {
      said << "; " << topic.without_channels << " messages of " << name << " with fewer than "
           << std::max(channels_.port, channels_.starboard) << " channels";
    }
  }
  return said.str();
}

std::string RosRecording::Contents() const {
  std::uint64_t messages = 0;
  std::uint64_t spoken = 0;
  for (const auto& [name, topic] : topics_) {
    messages += topic.messages;
    spoken += topic.messages > 0 ? 1 : 0;
  }
  std::ostringstream said;
  said << messages << (messages == 1 ? " message" : " messages") << " of use in " << spoken
       << (spoken == 1 ? " topic" : " topics");
  return said.str();
}

RosRecording::Sources RosRecording::BestSources() {
  Sources best;
  best.position = Best(&RosTopic::PositionRank);
  const std::string_view beside =
      best.position != nullptr ? best.position->first : std::string_view();
  best.heading = Best(OfKind(RosKind::kCompass), beside);
  if (best.heading == nullptr) best.heading = Best(OfKind(RosKind::kOrientation), beside);
  best.outputs = Best(OfKind(RosKind::kOutputs), beside);
  best.drive = Best(OfKind(RosKind::kDrive), beside);
  best.port = Best(OfSide(true), beside);
  best.starboard = Best(OfSide(false), beside);
  return best;
}

// One clock for all channels: that of the headers where every channel has it.
std::string RosRecording::AgreeOnClock(const Sources& best) {
  const std::array channels{best.position, best.heading, best.outputs};
  const bool use_stamps = std::ranges::all_of(
      channels, [](const Named* named) { return named == nullptr || named->second.StampsAgree(); });
  if (use_stamps) return "; times of the messages' headers where they have one";
  for (Named* named : channels) {
    if (named != nullptr) named->second.TimeByRecording();
  }
  return "; times of recording";
}

std::string RosRecording::TakeCommands(const Sources& best, SourceLog& log) const {
  std::ostringstream said;
  if (best.outputs != nullptr) {
    log.shared_output = SameChannel(channels_.port, channels_.starboard);
    if (log.shared_output) return {};
    said << "; outputs " << channels_.port << " (port) and " << channels_.starboard
         << " (starboard) of " << best.outputs->first;
    log.thrusters = std::move(best.outputs->second.commands);
  } else if (best.drive != nullptr) {
    said << "; outputs from " << best.drive->first
         << ", shares of full thrust taken as 1500 + 400 share us";
    log.thrusters = std::move(best.drive->second.commands);
  } else if (best.port != nullptr && best.starboard != nullptr) {
    said << TakeSides(*best.port, *best.starboard, log);
  }
  return said.str();
}

std::string RosRecording::RateWarnings(const Sources& best, const SourceLog& log) {
  std::string said;
  if (best.outputs != nullptr) {
    said += RateWarning(best.outputs->first, log.thrusters, kLowOutputHz,
                        "set SR0_RC_CHAN of the autopilot to 10, or ask for message 36 by the "
                        "service set_message_interval of MAVROS");
  }
  if (best.position != nullptr) {
    said += RateWarning(best.position->first, log.gnss, kLowPositionHz,
                        "set the receiver to 5 Hz or more");
  }
  if (best.heading != nullptr) {
    said +=
        RateWarning(best.heading->first, log.heading, kLowHeadingHz, "publish it at 10 Hz or more");
  }
  return said;
}

SourceLog RosRecording::Finish() && {
  const Sources best = BestSources();
  const std::string clock = AgreeOnClock(best);
  SourceLog log;
  log.summary = Contents();
  if (best.position != nullptr) log.summary += TakePositions(*best.position, log);
  if (best.heading != nullptr) log.summary += TakeHeadings(*best.heading, log);
  log.summary += TakeCommands(best, log);
  log.summary += RateWarnings(best, log) + clock + Faults() + FurtherPart(memory_.Summary());
  return log;
}

}  // namespace telltale
