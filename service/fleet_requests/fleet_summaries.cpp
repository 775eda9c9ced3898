#include "telltale/service/fleet_requests/fleet_summaries.hpp"

#include <optional>
#include <set>
#include <string_view>

#include "telltale/client/fleet/unix_now.hpp"

namespace telltale {
namespace {

VehicleSummary SummaryOfVehicle(const std::string& vehicle_id, VehicleWindow& window,
                                const PublishedModels& models) {
  const WindowState state = window.State();
  VehicleSummary summary;
  summary.vehicle_id = vehicle_id;
  summary.window_s = state.end_s - state.start_s;
  summary.window_fill = state.fill;
  const auto latest = models.Latest(vehicle_id);
  if (!latest) return summary;
  summary.revision = latest->model.revision;
  summary.model_age_s = UnixNow() - latest->model.published_unix_s;
  summary.promotion = latest->model.promotion;
  return summary;
}

/// A vehicle without a model meets every condition.
bool MeetsConditions(const FleetRequest& request, const std::optional<StoredModel>& latest) {
  if (!latest) return true;
  if (UnixNow() - latest->model.published_unix_s < request.older_than_s) return false;
  return request.worse_than == PromotionVerdict::kUnknown ||
         latest->model.promotion.verdict > request.worse_than;
}

}  // namespace

std::vector<VehicleSummary> SummariesOf(const Fleet& fleet, const PublishedModels& models) {
  std::vector<VehicleSummary> summaries;
  for (const auto& [vehicle_id, window] : fleet.windows()) {
    summaries.push_back(SummaryOfVehicle(vehicle_id, *window, models));
  }
  return summaries;
}

ModelSummary SummaryOf(const PublishedModel& model) {
  const Identification& identification = model.identification;
  return {model.revision,
          model.published_unix_s,
          std::string(Name(identification.structure)),
          std::string(Name(identification.estimator)),
          identification.window.start_s,
          identification.window.end_s,
          identification.window.samples,
          model.promotion};
}

std::vector<std::string> VehiclesToRefresh(const FleetRequest& request, const Fleet& fleet,
                                           const PublishedModels& models) {
  std::vector<std::string> named = request.vehicle_ids;
  if (request.all) {
    named.clear();
    for (const auto& [vehicle_id, window] : fleet.windows()) named.push_back(vehicle_id);
  }
  std::vector<std::string> chosen;
  std::set<std::string_view> seen;
  for (const std::string& vehicle_id : named) {
    if (!seen.insert(vehicle_id).second || fleet.IsServedElsewhere(vehicle_id)) continue;
    if (MeetsConditions(request, models.Latest(vehicle_id))) chosen.push_back(vehicle_id);
  }
  return chosen;
}

}  // namespace telltale
