#include "telltale/service/monitoring/model_monitor.hpp"

#include <utility>

#include <spdlog/spdlog.h>

#include "telltale/client/fleet/unix_now.hpp"
#include "telltale/core/data/recording_parts.hpp"
#include "telltale/service/models/free_run_error.hpp"

namespace telltale {
namespace {

constexpr double kEvaluatedSpanS = 60.0;
constexpr double kNewDataS = 5.0;     // the horizon: one more free-run window fits in
constexpr double kDriftWeight = 0.1;  // of the newest change: the mean is over about ten

}  // namespace

void ModelMonitor::Evaluate(VehicleWindow& window, double end_s, const StoredModel& model) {
  if (!model.reference_error) return;
  const std::uint64_t revision = model.model.revision;
  if (std::exchange(revision_, revision) != revision) {
    prediction_error_.reset();
    drift_ = 0.0;
    drift_detector_ = DriftDetector();
    rises_since_.reset();
  } else if (end_s < evaluated_to_s_ + kNewDataS) {
    return;
  }
  evaluated_to_s_ = end_s;
  const auto error = MeasureFreeRunError(Latest(window.Snapshot(), kEvaluatedSpanS),
                                         window.vehicle(), model.model.identification);
  if (error) Add(RelativeError(*error, *model.reference_error));
}

void ModelMonitor::Add(double relative_error) {
  if (prediction_error_) {
    drift_ += kDriftWeight * (relative_error - *prediction_error_ - drift_);
  }
  prediction_error_ = relative_error;
  drift_detector_.Add(relative_error);
  if (!drift_detector_.Rises()) {
    rises_since_.reset();
  } else if (!rises_since_) {
    rises_since_ = Onset{UnixNow(), evaluated_to_s_};
  }
}

std::optional<double> ModelMonitor::DriftSince() const {
  if (!drift_detector_.Fires() || !rises_since_) return std::nullopt;
  return rises_since_->unix_s;
}

std::optional<double> ModelMonitor::DriftOnsetS() const {
  if (!drift_detector_.Fires() || !rises_since_) return std::nullopt;
  return rises_since_->vehicle_s;
}

std::string ModelMonitor::Proposal(std::string_view vehicle_id) {
  const bool had_proposed = std::exchange(proposed_, drift_detector_.Fires());
  if (!proposed_) return "";
  std::string proposal = fmt::format(
      "revision {} predicts {:.1f} times worse than when it was made; "
      "telltale diagnose --vehicle-id {} asks why",
      revision_, prediction_error(), vehicle_id);
  if (!had_proposed) spdlog::warn("{}: {}", vehicle_id, proposal);
  return proposal;
}

}  // namespace telltale
