#include "telltale/core/data/samples.hpp"

#include <algorithm>
#include <numeric>

namespace telltale {

std::string_view Name(Channel channel) {
  switch (channel) {
    case Channel::kGnss: return "gnss";
    case Channel::kHeading: return "heading";
    case Channel::kThrusters: return "thrusters";
  }
  return "";
}

std::optional<Channel> ChannelNamed(std::string_view name) {
  const auto* const found = std::find_if(kChannels.begin(), kChannels.end(),
                                         [&](Channel channel) { return Name(channel) == name; });
  return found == kChannels.end() ? std::nullopt : std::optional(*found);
}

std::string_view Name(RejectReason reason) {
  switch (reason) {
    case RejectReason::kNotFinite: return "NOT_FINITE";
    case RejectReason::kOutOfRange: return "OUT_OF_RANGE";
    case RejectReason::kDuplicate: return "DUPLICATE";
    case RejectReason::kOutOfOrder: return "OUT_OF_ORDER";
    case RejectReason::kClockJump: return "CLOCK_JUMP";
    case RejectReason::kStuckSensor: return "STUCK_SENSOR";
    case RejectReason::kRepeated: return "REPEATED";
  }
  return "";
}

std::uint64_t RejectCounts::Of(RejectReason reason) const {
  std::uint64_t sum = 0;
  for (const Channel channel : kChannels) sum += Of(channel, reason);
  return sum;
}

std::uint64_t RejectCounts::Total() const {
  return std::accumulate(counts_.begin(), counts_.end(), std::uint64_t{0});
}

void RejectCounts::Add(const RejectCounts& other) {
  for (std::size_t i = 0; i < counts_.size(); ++i) counts_[i] += other.counts_[i];
}

}  // namespace telltale
