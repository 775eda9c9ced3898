#include "telltale/idl/codec/messages.hpp"

namespace telltale {

std::string_view Name(IdentifyOutcome outcome) {
  switch (outcome) {
    case IdentifyOutcome::kUnknown: return "UNKNOWN";
    case IdentifyOutcome::kPublished: return "PUBLISHED";
    case IdentifyOutcome::kRefused: return "REFUSED";
    case IdentifyOutcome::kFailed: return "FAILED";
  }
  return "";
}

std::vector<RejectEntry> Entries(const RejectCounts& counts) {
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
