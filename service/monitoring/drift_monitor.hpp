#pragma once

#include <optional>
#include <string>

#include "telltale/core/data/samples.hpp"
#include "telltale/core/drift/drift_test.hpp"
#include "telltale/core/identification/identification.hpp"
#include "telltale/core/vessel/vehicle.hpp"
#include "telltale/service/monitoring/onset_clock.hpp"

namespace telltale {

/// Follows one model of one vehicle from window to window of new telemetry, and tests whether the
/// vehicle has changed. The reference is what the vehicle's recording holds at the first call: for
/// a model that has just been made, what made it. Not thread safe.
class DriftMonitor {
 public:
  /// Takes the windows that are new since the last call. Nothing of a model that lacks an equation.
  void Follow(const Recording& recording, const Vehicle& vehicle,
              const Identification& identification);

  bool Fires() const { return test_.Fires(); }

  /// Since when there is evidence.
  const std::optional<OnsetTime>& onset() const { return onset_.onset(); }

  /// What has changed while it fires: "port thruster 14 % weaker".
  std::string Pattern() const;

 private:
  std::optional<DriftReference> reference_;
  double followed_to_s_ = 0.0;  ///< by the vehicle's clock
  DriftTest test_;
  OnsetClock onset_;
};

}  // namespace telltale
