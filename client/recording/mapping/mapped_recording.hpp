#pragma once

#include <string_view>
#include <vector>

#include "telltale/client/recording/mapping/mapped_samples.hpp"
#include "telltale/client/recording/source_log.hpp"

namespace telltale {

/// Gathers the three channels of what a mapping names. Assumes: the mapping outlives it.
class MappedRecording {
 public:
  explicit MappedRecording(const Mapping& mapping);
  MappedRecording(const MappedRecording&) = delete;
  MappedRecording& operator=(const MappedRecording&) = delete;

  /// Whether the mapping names this topic, so that a message of it need be opened at all.
  bool Names(std::string_view topic) const { return samples_.Names(topic); }

  void Take(std::string_view topic, double received_s, const MessageFields& fields) {
    samples_.Take(topic, received_s, fields);
  }

  /// Gives the samples away. `what`: "messages" or "rows", for people.
  SourceLog Finish(const char* what) &&;

 private:
  std::vector<GnssFix> fixes_;
  std::vector<HeadingSample> headings_;
  std::vector<SideCommand> port_commands_;
  std::vector<SideCommand> starboard_commands_;
  MappedSamples samples_;  // after what it writes to
};

}  // namespace telltale
