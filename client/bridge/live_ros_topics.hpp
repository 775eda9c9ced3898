#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "telltale/client/recording/mapping/mapped_samples.hpp"
#include "telltale/client/recording/ros/ros_topic.hpp"

namespace telltale {

/// Why a message of a live topic makes no sample.
enum class RosReject {
  kUnreadable,    ///< cut off, or of another layout than its type says
  kWithoutFix,    ///< a position without a fix, a heading without an orientation
  kClockUnknown,  ///< nothing yet says whose times count
  kOtherClock,    ///< its stamp is more than a second from its arrival, unlike those before
  kOtherTopic,    ///< its topic gives way to a better one
  kNotShares,     ///< a command that is neither a share in [-1, 1] nor a pulse width
  kNotMapped,     ///< without the fields that the mapping names, or a value that is held
};

inline constexpr std::array kRosRejects = {RosReject::kUnreadable,   RosReject::kWithoutFix,
                                           RosReject::kClockUnknown, RosReject::kOtherClock,
                                           RosReject::kOtherTopic,   RosReject::kNotShares,
                                           RosReject::kNotMapped};

std::string_view Name(RosReject reason);

/// Turns the topics of one vehicle into samples, message by message, by the rules of RosTopic.
///
/// Topics: the best one of a channel counts, in the order of RosRecording; it gives way once it has
/// been silent for three seconds; but odometry, whose origin is not stated, never stands in for
/// positions on the Earth. Clock: samples bear the stamps of their messages' headers where
/// these agree with the times of arrival to a second, else the times of arrival. The messages of
/// the first three seconds decide. Where stamps count and ten in a row of one topic disagree, the
/// times of arrival count from then on.
class LiveRosTopics {
 public:
  using Report = std::function<void(const std::string& what)>;
  using Reject = std::function<void(RosReject)>;

  LiveRosTopics(const SourceOptions& options, SampleSink sink, Reject reject, Report report);

  /// Whether messages of this topic say anything of a vehicle.
  static bool Names(std::string_view topic, std::string_view type) {
    return RosTopic(topic, type).Kind() != RosKind::kUnknown;
  }

  /// One message, and when it arrived, in UTC seconds by a clock that never goes back.
  void Take(std::string_view topic, std::string_view type, std::span<const std::uint8_t> bytes,
            double arrival_s);

 private:
  struct Topic {
    RosTopic source;
    bool ever_agreed = false;       ///< a stamp with an arrival
    std::uint64_t disagreeing = 0;  ///< stamps in a row
    bool is_refused = false;        ///< its values are neither shares nor pulses
  };
  using Named = std::pair<const std::string, Topic>;
  struct Chosen {
    std::string topic;
    int rank = 0;
    double heard_s = 0.0;
  };

  bool IsChosen(Chosen& chosen, const char* channel, const std::string& topic, int rank,
                double arrival_s);
  std::optional<double> TimeOf(Topic& topic, const RosReading& reading, double arrival_s);
  void TakePosition(Named& named, const RosReading& reading, double arrival_s);
  void TakeHeading(Named& named, const RosReading& reading, double arrival_s);
  void TakeCommands(Named& named, const RosReading& reading, double arrival_s);
  void TakeSide(Named& named, const RosReading& reading, double arrival_s);

  RosOutputChannels channels_;
  SampleSink sink_;
  Reject reject_;
  Report report_;
  std::map<std::string, Topic, std::less<>> topics_;
  Chosen positions_;
  Chosen headings_;
  Chosen commands_;
  Chosen port_;
  Chosen starboard_;
  std::optional<double> begun_s_;
  bool decided_ = false;
  bool stamps_count_ = true;
};

}  // namespace telltale
