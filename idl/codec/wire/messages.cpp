#include "telltale/idl/codec/wire/messages.hpp"

namespace telltale {

std::string_view Name(ReplyOutcome outcome) {
  switch (outcome) {
    case ReplyOutcome::kUnknown: return "UNKNOWN";
    case ReplyOutcome::kPublished: return "PUBLISHED";
    case ReplyOutcome::kRefused: return "REFUSED";
    case ReplyOutcome::kFailed: return "FAILED";
  }
  return "";
}

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
