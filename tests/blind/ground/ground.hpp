#pragma once

#include <optional>
#include <vector>

#include "ground/days.hpp"
#include "telltale/core/diagnosis/free_runs.hpp"
#include "telltale/core/diagnosis/gap.hpp"
#include "telltale/core/diagnosis/healthy.hpp"
#include "telltale/core/diagnosis/sensitivity.hpp"

namespace blind {

/// What a recording is held against by every method alike: free runs of five seconds, the boat that
/// the reference recordings have recalibrated, and how far it errs when all is well.
struct Ground {
  /// The days have to live on. Throws std::invalid_argument where no recording has a window.
  explicit Ground(const Days& days);

  /// (before^2 - after^2) / (before^2 - floor^2) for a model sailed on the recording; what effects
  /// that only shake are expected to add is taken off. None where the recalibrated boat errs no
  /// more than healthy days do.
  std::optional<double> ClosureBy(const telltale::AugmentedModel& model) const;

  /// G^2 of a model on the recording, less what shaking explains.
  double SquaredGap(const telltale::AugmentedModel& model) const;

  /// The recalibrated boat with effects.
  telltale::AugmentedModel With(const std::vector<telltale::ModelledEffect>& effects) const;

  const Days& days;
  std::vector<telltale::Slot> slots;
  telltale::FreeRuns runs;
  std::vector<telltale::FreeRuns> healthy_runs;
  telltale::Healthy healthy;
  telltale::Floor floor;
};

}  // namespace blind
