#include "telltale/idl/codec/messages/quality.hpp"

namespace telltale {

std::vector<RejectEntry> RejectEntries(const RejectCounts& counts) {
  std::vector<RejectEntry> entries;
  for (const Channel channel : kChannels) {
    for (const RejectReason reason : kRejectReasons) {
      if (const auto count = counts.Of(channel, reason); count > 0) {
        entries.push_back({std::string(Name(channel)), std::string(Name(reason)), count});
      }
    }
  }
  return entries;
}

}  // namespace telltale
