#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "telltale/client/recording/message_fields.hpp"
#include "telltale/client/recording/thruster_sides.hpp"
#include "telltale/core/data/samples.hpp"
#include "telltale/idl/codec/mapping_file.hpp"

namespace telltale {

/// Whether a topic has this name, in which * stands for any characters. A slash at the beginning of
/// either is left out of account.
bool TopicMatches(std::string_view of_pattern, std::string_view of_topic);

/// Where samples go, one by one, in the order in which they come.
struct SampleSink {
  std::function<void(const GnssFix&)> fix;
  std::function<void(const HeadingSample&)> heading;
  std::function<void(Side, const SideCommand&)> command;
};

/// The samples of what a mapping names, message by message. Of several topics that one pattern
/// matches the first counts. What the first stars of patterns that begin alike stand for is one
/// namespace, so that no channel is of another boat than the others.
/// Assumes: the mapping outlives it.
class MappedSamples {
 public:
  MappedSamples(const Mapping& mapping, SampleSink sink);

  /// Whether the mapping names this topic, so that a message of it need be opened at all.
  bool Names(std::string_view topic) const;

  void Take(std::string_view topic, double received_s, const MessageFields& fields);

  /// What was taken from where, for people. `what`: "messages" or "rows".
  std::string Summary(const char* what) const;

 private:
  /// One channel's topic and what could not be had from its messages.
  struct Source {
    std::string topic;
    bool is_taken = false;
    std::set<std::string, std::less<>> also;  ///< further topics that match
    std::uint64_t absent = 0;                 ///< messages without the fields
    std::uint64_t held = 0;                   ///< that repeat the value before
    std::uint64_t without_fix = 0;
  };

  bool IsFrom(Source& source, std::string_view pattern, std::string_view topic);
  bool IsOfTheBoat(std::string_view pattern, std::string_view topic);
  static std::optional<double> TimeOf(const MappedTime& time, double received_s,
                                      const MessageFields& fields);
  void TakePosition(double received_s, const MessageFields& fields);
  void TakeHeading(double received_s, const MessageFields& fields);
  void TakeCommand(Side side, const MappedThruster& thruster, double received_s,
                   const MessageFields& fields, Source& source);
  std::optional<double> HeadingOf(const MessageFields& fields) const;

  const Mapping& mapping_;
  SampleSink sink_;
  std::map<std::string, std::string, std::less<>> boat_;  ///< by what stands before a first star
  Source positions_;
  Source headings_;
  Source port_;
  Source starboard_;
  std::optional<GnssFix> last_fix_;
  std::optional<double> last_heading_deg_;
  std::uint64_t messages_ = 0;
};

}  // namespace telltale
