#include "telltale/client/cli/quality_table.hpp"

#include <numeric>

#include "telltale/client/cli/table.hpp"

namespace telltale {
namespace {

std::string Total(const std::vector<RejectEntry>& rejected) {
  const auto total = std::accumulate(
      rejected.begin(), rejected.end(), std::uint64_t{0},
      [](std::uint64_t sum, const RejectEntry& entry) { return sum + entry.count; });
  return std::to_string(total);
}

/// Live and indicative: what surge gets of forward thrust, with its error.
std::string ForwardThrust(const Quality& quality) {
  for (const IndicativeCoefficient& c : quality.indicative) {
    if (c.equation != Equation::kSurge || c.regressor != "f:d") continue;
    return Significant(c.estimate, 2) + "±" + Significant(c.standard_error, 1);
  }
  return "";
}

std::string RejectedOf(const std::string& subject, const std::vector<RejectEntry>& rejected) {
  std::string text;
  for (const RejectEntry& entry : rejected) {
    text += (text.empty() ? "" : ", ") + entry.channel + ' ' + std::to_string(entry.count) + ' ' +
            entry.reason;
  }
  return text.empty() ? "" : Wrapped(subject + " rejected: " + text);
}

}  // namespace

std::string QualityTable(const std::map<std::string, Quality>& fleet) {
  Table table({{"vehicle"},
               {"window s", Align::kRight},
               {"fill %", Align::kRight},
               {"gnss Hz", Align::kRight},
               {"head Hz", Align::kRight},
               {"thr Hz", Align::kRight},
               {"lost", Align::kRight},
               {"rejected", Align::kRight},
               {"model", Align::kRight},
               {"age s", Align::kRight},
               {"error", Align::kRight},
               {"drift", Align::kRight},
               {"~f:d", Align::kRight}});
  std::string notes;
  for (const auto& [vehicle_id, quality] : fleet) {
    if (vehicle_id == kUnattributed) {
      notes += RejectedOf("for no vehicle here", quality.rejected);
      continue;
    }
    const bool modelled = quality.model_revision.has_value();
    table.AddRow(
        {vehicle_id, Fixed(quality.window_s, 0), Fixed(100.0 * quality.window_fill, 0),
         Fixed(quality.gnss_rate_hz, 1), Fixed(quality.heading_rate_hz, 1),
         Fixed(quality.thrusters_rate_hz, 1), std::to_string(quality.lost), Total(quality.rejected),
         modelled ? std::to_string(*quality.model_revision) : "none",
         modelled ? Fixed(quality.model_age_s, 0) : "",
         quality.prediction_error > 0.0 ? Fixed(quality.prediction_error, 2) : "",
         quality.prediction_error > 0.0 ? Fixed(quality.drift, 2) : "", ForwardThrust(quality)});
    notes += RejectedOf(vehicle_id, quality.rejected);
    if (!quality.proposal.empty()) notes += Wrapped(vehicle_id + ": " + quality.proposal);
  }
  return table.Render() + notes;
}

}  // namespace telltale
