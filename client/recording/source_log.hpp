#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "telltale/client/recording/block_reader.hpp"
#include "telltale/client/recording/sample_memory.hpp"
#include "telltale/client/recording/servo_outputs.hpp"
#include "telltale/client/recording/time_order.hpp"
#include "telltale/core/base/result.hpp"
#include "telltale/idl/codec/mapping_file.hpp"

namespace telltale {

/// What to take from a file where it offers a choice. Channels are counted from 1.
struct SourceOptions {
  std::optional<int> gps_instance;       ///< of DataFlash, [0, 255]; unset: the one with most fixes
  std::optional<int> system_id;          ///< of MAVLink, [1, 255]; unset: the one that says most
  std::optional<int> port_channel;       ///< [1, 16]; unset: by SERVOn_FUNCTION 73
  std::optional<int> starboard_channel;  ///< [1, 16]; unset: by SERVOn_FUNCTION 74
  std::size_t memory_bytes = kReadingBytes;  ///< that samples may take while they are read
  std::shared_ptr<const Mapping> mapping;    ///< null: what is known of each format counts
  ReadProgress progress;                     ///< null: nobody is told

  /// The first field out of its range, as a refusal naming field, value and range.
  std::optional<Refusal> Validate() const;
};

/// Three channels out of a file of any format, on one clock, and what was chosen to get them.
struct SourceLog : RawChannels {
  std::optional<ThrusterOutput> port;  ///< where the file describes its outputs
  std::optional<ThrusterOutput> starboard;
  std::optional<Refusal> shared_output;  ///< where one output stands for both thrusters
  std::string summary;  ///< for people: what was read, from where, and each kind of damage

  /// Each channel that is missing, in the order of kChannels, with the reason and what to do.
  std::vector<Refusal> Lacks() const;
};

}  // namespace telltale
