#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "telltale/core/data/samples.hpp"

namespace telltale {

/// What a recording is known by once its samples are no longer at hand.
struct RecordingIdentity {
  std::string name;      ///< of the log, for people; two recordings may share it
  double start_s = 0.0;  ///< first and last fix, on the recording's own clock
  double end_s = 0.0;
  std::size_t fixes = 0;
  /// CRC-32 of one fix every ten seconds: time in ms, position in 1e-7 degrees.
  std::vector<std::uint32_t> marks;
};

/// Requires: times ascend.
RecordingIdentity IdentityOf(const Recording& recording, std::string name);

/// Whether `recording` holds the recording of that identity or a part of it: at least three of its
/// marks, or all where it has fewer. A part of less than about half a minute goes unnoticed.
/// Assumes: both have the same clock; a recording whose clock was shifted counts as another.
bool SharesFixes(const RecordingIdentity& identity, const Recording& recording);

}  // namespace telltale
