#include "telltale/service/monitoring/quality_verdict.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include <spdlog/fmt/fmt.h>

namespace telltale {
namespace {

using enum QualityVerdict;

class Reasons {
 public:
  void Add(std::string code, QualityVerdict verdict, std::string text) {
    reasons_.push_back({std::move(code), verdict, std::move(text)});
  }
  std::vector<QualityReason> MostSeriousFirst() && {
    std::ranges::stable_sort(reasons_, {}, [](const QualityReason& r) {
      return std::pair(r.verdict == kStale ? 0 : 1, SeverityRank(r.verdict));
    });
    return std::move(reasons_);
  }

 private:
  std::vector<QualityReason> reasons_;
};

std::string_view ChannelWord(Channel channel) {
  switch (channel) {
    case Channel::kGnss: return "position";
    case Channel::kHeading: return "heading";
    case Channel::kThrusters: return "thruster";
  }
  return "";
}

void AddSilence(const LastMinute& last, const VerdictLimits& limits, Reasons& reasons) {
  if (!last.ever_arrived) {
    return reasons.Add("NO_TELEMETRY", kStale, "no telemetry since the daemon started");
  }
  if (last.SilentS() > limits.silent_s) {
    return reasons.Add("NO_TELEMETRY", kStale,
                       fmt::format("no telemetry for {:.0f} s", last.SilentS()));
  }
  for (const Channel channel : kChannels) {
    const double silent_s = last.silent_s[static_cast<std::size_t>(channel)];
    if (silent_s <= limits.silent_s) continue;
    reasons.Add("CHANNEL_SILENT", kError,
                fmt::format("no {} samples for {:.0f} s", ChannelWord(channel), silent_s));
  }
}

/// "heading OUT_OF_ORDER": the most frequent fault of the last minute.
std::string MostFrequentFault(const RejectCounts& rejected) {
  std::uint64_t most = 0;
  std::string fault;
  for (const Channel channel : kChannels) {
    for (const RejectReason reason : kRejectReasons) {
      const std::uint64_t count = rejected.Of(channel, reason);
      if (count <= most) continue;
      most = count;
      fault = fmt::format("{} {}", ChannelWord(channel), Name(reason));
    }
  }
  return fault;
}

void AddRejects(const LastMinute& last, const VerdictLimits& limits, Reasons& reasons) {
  const double share = last.RejectShare();
  if (share > limits.reject_share) {
    reasons.Add(
        "REJECTED", share > limits.useless_share ? kError : kWarn,
        fmt::format("{:.0f} % of the samples of the last minute are rejected, most often {}",
                    100.0 * share, MostFrequentFault(last.rejected)));
  }
  const auto stuck = last.rejected.Of(RejectReason::kStuckSensor);
  if (stuck >= limits.faults) {
    reasons.Add("STUCK_SENSOR", kWarn,
                fmt::format("a sensor is stuck: {} repeated readings in the last minute", stuck));
  }
}

/// A clock that jumps for good, or stamps far off it that no later ones agree with.
void AddClock(const LastMinute& last, const VerdictLimits& limits, Reasons& reasons) {
  const auto off_clock = last.rejected.Of(RejectReason::kClockJump);
  if (last.clock_jumps > 0) {
    reasons.Add(
        "CLOCK_JUMP", kWarn,
        fmt::format("the boat's clock jumped {} in the last minute",
                    last.clock_jumps == 1 ? "once" : fmt::format("{} times", last.clock_jumps)));
  } else if (off_clock >= limits.faults) {
    reasons.Add(
        "CLOCK_JUMP", kWarn,
        fmt::format("{} stamps of the last minute are far off the boat's clock", off_clock));
  }
}

void AddLoss(const LastMinute& last, const VerdictLimits& limits, Reasons& reasons) {
  if (last.LossShare() <= limits.loss_share) return;
  reasons.Add("LOST", kWarn,
              fmt::format("{:.0f} % of the samples of the last minute are lost on the way",
                          100.0 * last.LossShare()));
}

void AddShedding(const LastMinute& last, const VerdictLimits& limits, Reasons& reasons) {
  if (last.ShedShare() <= limits.shed_share) return;
  reasons.Add("SHED", kWarn,
              fmt::format("{:.0f} % of the samples of the last minute are left aside: more come "
                          "than the daemon takes in",
                          100.0 * last.ShedShare()));
}

void AddModel(const Quality& quality, const VerdictLimits& limits, Reasons& reasons) {
  if (quality.last_refusal) {
    reasons.Add("REFUSED", kWarn,
                fmt::format("the last identification is refused: {}: {}",
                            quality.last_refusal->subject, quality.last_refusal->reason));
  } else if (!quality.model_revision) {
    reasons.Add("NO_MODEL", kWarn,
                fmt::format("there is no model; telltale identify --vehicle-id {} makes one",
                            quality.vehicle_id));
  }
  if (quality.model_verdict.verdict == PromotionVerdict::kError) {
    reasons.Add("MODEL_ERROR", kError,
                fmt::format("revision {} is not to be relied on: {}",
                            quality.model_revision.value_or(0), quality.model_verdict.reason));
  }
  if (quality.drift_since_unix_s > 0.0) {
    reasons.Add("DRIFT", quality.prediction_error >= limits.error_ratio ? kError : kWarn,
                "the model no longer matches the boat: " + quality.drift_evidence);
  }
}

}  // namespace

std::vector<QualityReason> ReasonsOf(const Quality& quality, const LastMinute& last,
                                     const std::optional<std::string>& store_fault,
                                     const VerdictLimits& limits) {
  Reasons reasons;
  AddSilence(last, limits, reasons);
  AddRejects(last, limits, reasons);
  AddClock(last, limits, reasons);
  AddLoss(last, limits, reasons);
  AddShedding(last, limits, reasons);
  AddModel(quality, limits, reasons);
  if (store_fault) reasons.Add("NOT_SAVED", kWarn, "what comes is not saved: " + *store_fault);
  return std::move(reasons).MostSeriousFirst();
}

void AddSourceFaults(const std::vector<std::string>& faults, std::vector<QualityReason>& reasons) {
  const bool is_silent = std::ranges::any_of(reasons, [](const QualityReason& reason) {
    return reason.code == "NO_TELEMETRY" || reason.code == "CHANNEL_SILENT";
  });
  if (!is_silent) return;
  for (const std::string& fault : faults) {
    reasons.push_back({"SOURCE_FAILED", kWarn, "nothing comes from source " + fault});
  }
}

QualityVerdict VerdictOf(const std::vector<QualityReason>& reasons) {
  return reasons.empty() ? kOk : reasons.front().verdict;
}

}  // namespace telltale
