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

std::string_view Name(QualityVerdict verdict) {
  switch (verdict) {
    case QualityVerdict::kOk: return "OK";
    case QualityVerdict::kWarn: return "WARN";
    case QualityVerdict::kError: return "ERROR";
    case QualityVerdict::kStale: return "STALE";
    case QualityVerdict::kUnknown: break;
  }
  return "";
}

int SeverityRank(QualityVerdict verdict) {
  switch (verdict) {
    case QualityVerdict::kError: return 0;
    case QualityVerdict::kStale: return 1;
    case QualityVerdict::kWarn: return 2;
    case QualityVerdict::kOk: return 3;
    case QualityVerdict::kUnknown: break;
  }
  return 4;
}

}  // namespace telltale
