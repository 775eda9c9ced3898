#include "telltale/service/monitoring/model_monitor.hpp"

#include <utility>

#include <spdlog/fmt/fmt.h>

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
    drift_monitor_ = DriftMonitor();
  } else if (end_s >= evaluated_to_s_ && end_s < evaluated_to_s_ + kNewDataS) {
    return;
  }
  evaluated_to_s_ = end_s;
  const Recording recording = window.Snapshot();
  drift_monitor_.Follow(recording, window.vehicle(), model.model.identification,
                        *model.reference_error);
  const auto error = MeasureFreeRunError(Latest(recording, kEvaluatedSpanS), window.vehicle(),
                                         model.model.identification);
  if (error) Add(RelativeError(*error, *model.reference_error));
}

void ModelMonitor::Add(double relative_error) {
  if (prediction_error_) {
    drift_ += kDriftWeight * (relative_error - *prediction_error_ - drift_);
  }
  prediction_error_ = relative_error;
}

std::string ModelMonitor::DriftEvidence() const {
  if (!DriftOnset()) return "";
  const std::string pattern = drift_monitor_.Pattern();
  if (!pattern.empty())
    return fmt::format("the errors of revision {} show: {}", revision_, pattern);
  return fmt::format(
      "revision {} errs {:.1f} times as much as when it was made, as the commands change",
      revision_, drift_monitor_.CommandedError());
}

}  // namespace telltale
