#pragma once

#include <optional>
#include <string>

#include "telltale/core/data/samples.hpp"
#include "telltale/core/drift/drift_test.hpp"
#include "telltale/core/identification/identification.hpp"
#include "telltale/core/vessel/vehicle.hpp"
#include "telltale/service/monitoring/onset_clock.hpp"

namespace telltale {

/// Follows one model of one vehicle from minute to minute of new telemetry, and tests whether the
/// vehicle has changed. The reference is what the vehicle's recording holds at the first call at
/// which that is enough: for a model that has just been made, what made it; after a restart of the
/// daemon, what its window holds then. Not thread safe.
class DriftMonitor {
 public:
  /// Takes what came since the last call, where that is a minute or more. Nothing of a model that
  /// lacks an equation or diverges.
  void Follow(const Recording& recording, const Vehicle& vehicle,
              const Identification& identification);

  bool Fires() const { return test_ && test_->Fires(); }

  /// Since when there is evidence.
  const std::optional<OnsetTime>& onset() const { return onset_.onset(); }

  /// What has changed while it fires: "port thruster 14 % weaker", the likeliest first where
  /// several changes explain the errors nearly as well.
  std::string Pattern() const;

 private:
  std::optional<DriftReference> reference_;
  double followed_to_s_ = 0.0;     ///< by the vehicle's clock
  std::optional<DriftTest> test_;  ///< once there is a reference
  OnsetClock onset_;
};

}  // namespace telltale
