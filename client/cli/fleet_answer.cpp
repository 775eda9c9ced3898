#include "telltale/client/cli/fleet_answer.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

#include "telltale/client/bus/participant.hpp"
#include "telltale/client/cli/duration_text.hpp"
#include "telltale/client/cli/table.hpp"
#include "telltale/client/fleet/fleet_client.hpp"

namespace telltale {
namespace {

std::string ReasonLine(const std::string& subject, const std::string& reason) {
  return reason.empty() ? "" : Wrapped(subject + ": " + reason);
}

std::string Lower(std::string_view name) {
  std::string lower(name);
  std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return std::tolower(c); });
  return lower;
}

/// Revisions count from 1, so that the newest says how many there have been. Empty where all are
/// there.
std::string MissingRevisions(const std::vector<ModelSummary>& newest_first) {
  if (newest_first.empty()) return "";
  const std::uint64_t made = newest_first.front().revision;
  if (made <= newest_first.size()) return "";
  return std::to_string(made - newest_first.size()) + " of " + std::to_string(made) +
         " revisions are no longer kept.\n";
}

}  // namespace

FleetReply AskFleet(FleetRequest request, const LiveOptions& live,
                    const std::function<void(const FleetProgress&)>& progress) {
  const Participant participant(live.domain);
  FleetClient client(participant);
  if (request.correlation_id.empty()) request.correlation_id = NewCorrelationId();
  auto result = client.Ask(request, live.Timing(), progress);
  RequirePublished(result, "the fleet", live);
  return *std::move(result.reply);
}

void RequireWholeFleet(const FleetRequest& request, const FleetReply& reply) {
  const SliceSet unanswered = UnansweredSlices(request, reply);
  if (unanswered == 0) return;
  std::string numbers;
  for (int slice = 0; slice < kFleetSlices; ++slice) {
    if ((unanswered & SetOf(slice)) == 0) continue;
    numbers += (numbers.empty() ? "" : ", ") + std::to_string(slice);
  }
  throw std::runtime_error("no daemon answered for " + std::to_string(std::popcount(unanswered)) +
                           " of " + std::to_string(kFleetSlices) + " slices of the fleet (" +
                           numbers + "), so their boats are missing: is a daemon down?");
}

std::string VerdictText(PromotionVerdict verdict) {
  return verdict == PromotionVerdict::kUnknown ? "-" : std::string(Name(verdict));
}

std::string VehicleListTable(const std::vector<VehicleSummary>& vehicles) {
  Table table({{"vehicle"},
               {"window s", Align::kRight},
               {"fill %", Align::kRight},
               {"model", Align::kRight},
               {"age", Align::kRight},
               {"verdict"}});
  std::string reasons;
  for (const VehicleSummary& vehicle : vehicles) {
    const bool modelled = vehicle.revision > 0;
    table.AddRow({vehicle.vehicle_id, Fixed(vehicle.window_s, 0),
                  Fixed(100.0 * vehicle.window_fill, 0),
                  modelled ? std::to_string(vehicle.revision) : "none",
                  modelled ? DurationText(vehicle.model_age_s) : "",
                  modelled ? VerdictText(vehicle.promotion.verdict) : ""});
    reasons += ReasonLine(vehicle.vehicle_id, vehicle.promotion.reason);
  }
  return table.Render() + reasons;
}

std::string ModelHistoryTable(const std::vector<ModelSummary>& models) {
  Table table({{"revision", Align::kRight},
               {"published (UTC)"},
               {"estimator"},
               {"data s", Align::kRight},
               {"rows", Align::kRight},
               {"verdict"}});
  std::string reasons;
  for (const ModelSummary& model : models) {
    table.AddRow({std::to_string(model.revision), UtcText(model.published_unix_s), model.estimator,
                  Fixed(model.window_end_s - model.window_start_s, 0),
                  std::to_string(model.window_samples), VerdictText(model.promotion.verdict)});
    reasons += ReasonLine("revision " + std::to_string(model.revision), model.promotion.reason);
  }
  return table.Render() + reasons + MissingRevisions(models);
}

std::string RefreshSummaryText(const std::vector<RefreshedVehicle>& vehicles) {
  std::map<RefreshState, std::size_t> counts;
  std::map<PromotionVerdict, std::size_t> verdicts;
  std::string reasons;
  for (const RefreshedVehicle& vehicle : vehicles) {
    ++counts[vehicle.state];
    const bool published = vehicle.state == RefreshState::kPublished;
    if (published) ++verdicts[vehicle.verdict];
    const bool plain = vehicle.state == RefreshState::kUnchanged ||
                       (published && vehicle.verdict <= PromotionVerdict::kOk);
    if (plain || vehicle.reason.empty()) continue;
    const std::string what =
        published ? std::string(Name(vehicle.verdict)) : Lower(Name(vehicle.state));
    reasons += Wrapped(vehicle.vehicle_id + ": " + what + ", " + vehicle.reason, "  ");
  }
  std::string text;
  for (const RefreshState state : kRefreshStates) {
    const std::size_t count = counts[state];
    const bool always = state == RefreshState::kPublished || state == RefreshState::kUnchanged ||
                        state == RefreshState::kRefused || state == RefreshState::kFailed;
    if (count == 0 && !always) continue;
    text += (text.empty() ? "" : ", ") + Lower(Name(state)) + ' ' + std::to_string(count);
    if (state != RefreshState::kPublished) continue;
    for (const auto verdict : {PromotionVerdict::kWarn, PromotionVerdict::kError}) {
      if (verdicts[verdict] == 0) continue;
      text += " (" + std::to_string(verdicts[verdict]) + ' ' + std::string(Name(verdict)) + ')';
    }
  }
  return text + '\n' + reasons;
}

}  // namespace telltale
