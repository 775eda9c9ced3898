#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <unordered_set>
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

/// The marks of all fixes of a recording at hand, with which identities are compared.
using FixMarks = std::unordered_set<std::uint32_t>;
FixMarks MarksOf(const Recording& recording);

/// Whether a recording with these marks holds the recording of that identity or a part of it: at
/// least three of its marks, or all where it has fewer. A part of less than about half a minute
/// goes unnoticed. Assumes: both have the same clock; a recording whose clock was shifted counts as
/// another.
bool SharesFixes(const RecordingIdentity& identity, const FixMarks& marks);

/// Whether one of two recordings holds the other or a part of it.
bool Overlap(const RecordingIdentity& one, const FixMarks& marks_of_one,
             const RecordingIdentity& other, const FixMarks& marks_of_other);

}  // namespace telltale
