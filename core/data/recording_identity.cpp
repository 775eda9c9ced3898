#include "telltale/core/data/recording_identity.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <boost/crc.hpp>

namespace telltale {
namespace {

constexpr double kMarkEveryS = 10.0;
// One mark may coincide: boats that lie at the same place when their clock is zero, or chance.
constexpr std::size_t kMarksThatTell = 3;

/// Rounded as formats of logs round, so that another format of the same recording has the same.
std::uint32_t MarkOf(const GnssFix& fix) {
  const std::array<std::int64_t, 3> rounded = {std::llround(fix.time_s * 1e3),
                                               std::llround(fix.latitude_deg * 1e7),
                                               std::llround(fix.longitude_deg * 1e7)};
  boost::crc_32_type crc;
  crc.process_bytes(rounded.data(), sizeof rounded);
  return crc.checksum();
}

}  // namespace

RecordingIdentity IdentityOf(const Recording& recording, std::string name) {
  RecordingIdentity identity;
  identity.name = std::move(name);
  identity.fixes = recording.gnss.size();
  if (recording.gnss.empty()) return identity;
  identity.start_s = recording.gnss.front().time_s;
  identity.end_s = recording.gnss.back().time_s;
  double next_s = identity.start_s;
  for (const GnssFix& fix : recording.gnss) {
    if (fix.time_s < next_s) continue;
    identity.marks.push_back(MarkOf(fix));
    next_s = fix.time_s + kMarkEveryS;
  }
  return identity;
}

FixMarks MarksOf(const Recording& recording) {
  FixMarks marks;
  for (const GnssFix& fix : recording.gnss) marks.insert(MarkOf(fix));
  return marks;
}

bool SharesFixes(const RecordingIdentity& identity, const FixMarks& marks) {
  const auto shared = static_cast<std::size_t>(
      std::count_if(identity.marks.begin(), identity.marks.end(),
                    [&](std::uint32_t mark) { return marks.contains(mark); }));
  return shared > 0 && shared >= std::min(kMarksThatTell, identity.marks.size());
}

bool Overlap(const RecordingIdentity& one, const FixMarks& marks_of_one,
             const RecordingIdentity& other, const FixMarks& marks_of_other) {
  return SharesFixes(one, marks_of_other) || SharesFixes(other, marks_of_one);
}

}  // namespace telltale
