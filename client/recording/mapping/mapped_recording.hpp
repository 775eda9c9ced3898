#pragma once

#include <cstddef>
#include <string_view>

#include "telltale/client/recording/mapping/mapped_samples.hpp"
#include "telltale/client/recording/sample_memory.hpp"
#include "telltale/client/recording/source_log.hpp"

namespace telltale {

/// Gathers the three channels of what a mapping names. Assumes: the mapping outlives it.
class MappedRecording {
 public:
  explicit MappedRecording(const Mapping& mapping, std::size_t most_bytes = kReadingBytes);
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
  SampleMemory memory_;
  SampleSeries<GnssFix> fixes_{memory_};
  SampleSeries<HeadingSample> headings_{memory_};
  SampleSeries<SideCommand> port_commands_{memory_};
  SampleSeries<SideCommand> starboard_commands_{memory_};
  MappedSamples samples_;  // after what it writes to
};

}  // namespace telltale
