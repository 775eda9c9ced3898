#include "telltale/idl/codec/json/fleet_answer.hpp"

#include <algorithm>
#include <cstdint>

#include "telltale/idl/codec/json/json_message.hpp"
#include "telltale/idl/proto/fleet_answer.pb.h"

namespace telltale {
namespace {

std::string VerdictText(PromotionVerdict verdict) {
  return verdict == PromotionVerdict::kUnknown ? "" : std::string(Name(verdict));
}

void Write(const VehicleSummary& vehicle, proto::ListedVehicle& message) {
  message.set_vehicle_id(vehicle.vehicle_id);
  message.set_window_s(vehicle.window_s);
  message.set_window_fill(vehicle.window_fill);
  message.set_revision(static_cast<std::uint32_t>(vehicle.revision));
  message.set_model_age_s(vehicle.model_age_s);
  message.set_verdict(VerdictText(vehicle.promotion.verdict));
  message.set_verdict_reason(vehicle.promotion.reason);
}

void Write(const ModelSummary& model, proto::StoredModel& message) {
  message.set_revision(static_cast<std::uint32_t>(model.revision));
  message.set_published_unix_s(model.published_unix_s);
  message.set_structure(model.structure);
  message.set_estimator(model.estimator);
  message.set_window_start_s(model.window_start_s);
  message.set_window_end_s(model.window_end_s);
  message.set_window_samples(static_cast<std::uint32_t>(model.window_samples));
  message.set_verdict(VerdictText(model.promotion.verdict));
  message.set_verdict_reason(model.promotion.reason);
}

void Write(const RefreshedVehicle& vehicle, proto::RefreshedVehicle& message) {
  message.set_vehicle_id(vehicle.vehicle_id);
  message.set_state(std::string(Name(vehicle.state)));
  message.set_revision(static_cast<std::uint32_t>(vehicle.revision));
  message.set_verdict(VerdictText(vehicle.verdict));
  message.set_reason(vehicle.reason);
}

std::uint32_t CountOf(const FleetReply& reply, RefreshState state) {
  return static_cast<std::uint32_t>(
      std::ranges::count(reply.refreshed, state, &RefreshedVehicle::state));
}

}  // namespace

std::string PrintVehicleListJson(std::span<const VehicleSummary> vehicles) {
  proto::ListedVehicles message;
  for (const VehicleSummary& vehicle : vehicles) Write(vehicle, *message.add_vehicles());
  return PrintJsonMessage(message);
}

std::string PrintModelHistoryJson(std::string_view vehicle_id,
                                  std::span<const ModelSummary> models) {
  proto::StoredModels message;
  message.set_vehicle_id(std::string(vehicle_id));
  for (const ModelSummary& model : models) Write(model, *message.add_models());
  return PrintJsonMessage(message);
}

std::string PrintRefreshJson(std::string_view refresh_id, const FleetReply& reply) {
  proto::RefreshSummary message;
  message.set_refresh_id(std::string(refresh_id));
  message.set_elapsed_s(reply.elapsed_s);
  message.set_published(CountOf(reply, RefreshState::kPublished));
  message.set_unchanged(CountOf(reply, RefreshState::kUnchanged));
  message.set_refused(CountOf(reply, RefreshState::kRefused));
  message.set_failed(CountOf(reply, RefreshState::kFailed));
  message.set_cancelled(CountOf(reply, RefreshState::kCancelled));
  for (const RefreshedVehicle& vehicle : reply.refreshed) Write(vehicle, *message.add_vehicles());
  return PrintJsonMessage(message);
}

}  // namespace telltale
