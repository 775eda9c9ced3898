#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "telltale/idl/codec/messages/quality.hpp"
#include "telltale/service/ingest/vehicle_window.hpp"
#include "telltale/service/models/model_store.hpp"
#include "telltale/service/monitoring/fleet_view.hpp"
#include "telltale/service/monitoring/live_estimator.hpp"
#include "telltale/service/monitoring/model_monitor.hpp"
#include "telltale/service/monitoring/recent_telemetry.hpp"

namespace telltale {

/// The quality of one vehicle from period to period: rates of its telemetry, live estimates, and
/// how well its latest model predicts, and what verdict they amount to. Not thread safe.
class VehicleMonitor {
 public:
  /// The quality of the period that ends now and that has lasted `elapsed_s`.
  /// `view` knows the last refusal, the last diagnosis and the sources that fail, `store_fault` why
  /// something is not saved.
  Quality Assess(VehicleWindow& window, const std::optional<StoredModel>& latest,
                 const FleetView& view, const std::optional<std::string>& store_fault,
                 double elapsed_s);

  /// The onset of the drift by the vehicle's clock, while there is one.
  std::optional<double> DriftOnsetS() const {
    const auto onset = model_.DriftOnset();
    return onset ? std::optional(onset->vehicle_s) : std::nullopt;
  }

  /// The quality of the last period with the counts of now.
  Quality Receipt(VehicleWindow& window);

 private:
  void AddModel(VehicleWindow& window, double end_s, const StoredModel& latest, Quality& quality);
  /// Each onset once.
  void LogDrift(const Quality& quality);
  void Decide(const WindowState& state, const FleetView& view,
              const std::optional<std::string>& store_fault, Quality& quality);
  void UpdateEstimates(VehicleWindow& window, const WindowState& state);

  std::uint64_t published_ = 0;
  Quality assessed_;  ///< of the last period
  WindowState last_;  ///< at the end of the period before
  LiveEstimator live_;
  std::vector<IndicativeCoefficient> indicative_;
  ModelMonitor model_;
  bool drifts_ = false;  ///< at the end of the last period
  RecentTelemetry recent_;
  QualityVerdict verdict_ = QualityVerdict::kUnknown;  ///< of the last period
  double verdict_since_unix_s_ = 0.0;
};

}  // namespace telltale
