#pragma once

#include <optional>
#include <string>

#include "telltale/core/data/samples.hpp"
#include "telltale/core/drift/commanded_error_test.hpp"
#include "telltale/core/drift/drift_test.hpp"
#include "telltale/core/identification/identification.hpp"
#include "telltale/core/vessel/vehicle.hpp"
#include "telltale/service/models/free_run_error.hpp"
#include "telltale/service/monitoring/onset_clock.hpp"

namespace telltale {

/// Follows one model of one vehicle from minute to minute of new telemetry, and tests whether the
/// vehicle has changed: by a known change that its errors show, or by large errors that follow the
/// commands. A model that does not know its thrust, KnowsThrust(), shows no known change. The
/// reference of the known changes is what the vehicle's recording holds at the first call at which
/// that is enough: for a model that has just been made, what made it; after a restart of the
/// daemon, what its window holds then. Not thread safe.
class DriftMonitor {
 public:
  /// Takes what came since the last call, where that is a minute or more. Nothing of a model that
  /// lacks an equation or diverges. `normal` is the error when the model was made.
  void Follow(const Recording& recording, const Vehicle& vehicle,
              const Identification& identification, const FreeRunError& normal);

  bool Fires() const { return onset().has_value(); }

  /// Since when there is evidence, while it fires.
  const std::optional<OnsetTime>& onset() const { return onset_.onset(); }

  /// What has changed: "port thruster 14 % weaker", the likeliest first where several changes
  /// explain the errors nearly as well; empty where the errors show no known change.
  std::string Pattern() const;

  /// Of which changes it cannot tell now, and why: "drag: commands and heading vary too little";
  /// empty where it tests all.
  std::string Untested() const;

  /// The error that follows the commands, in units of `normal`; 0 where it is not known yet.
  double CommandedError() const { return commanded_error_ ? commanded_error_->Explained() : 0.0; }

 private:
  void NoteOnset(double settled_s);

  bool knows_thrust_ = true;  ///< the model
  std::optional<DriftReference> reference_;
  double followed_to_s_ = 0.0;        ///< by the vehicle's clock
  std::optional<DriftTest> changes_;  ///< once there is a reference
  std::optional<CommandedErrorTest> commanded_error_;
  OnsetClock change_onset_;
  OnsetClock error_onset_;
  EarliestOnset onset_;
};

}  // namespace telltale
