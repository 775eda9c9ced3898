#pragma once

#include <optional>
#include <vector>

#include "inputs/diagnosis_inputs.hpp"
#include "telltale/core/diagnosis/baseline/nominal_baseline.hpp"
#include "telltale/core/diagnosis/residuals/free_runs.hpp"
#include "telltale/core/diagnosis/residuals/gap.hpp"
#include "telltale/core/diagnosis/residuals/sensitivity.hpp"

namespace blind {

/// What a recording is held against by every method alike: free runs of five seconds, the boat that
/// the reference recordings have recalibrated, and how far it errs when all is well.
struct ReferenceBasis {
  /// The days have to live on. Throws std::invalid_argument where no recording has a window.
  explicit ReferenceBasis(const DiagnosisInputs& inputs);

  /// (before^2 - after^2) / (before^2 - floor^2) for a model simulated on the recording; what
  /// effects that only shake are expected to add is taken off. None where the recalibrated boat
  /// errs no more than nominal days do.
  std::optional<double> ClosureBy(const telltale::AugmentedModel& model) const;

  /// G^2 of a model on the recording, less what stochastic excitation explains.
  double SquaredGap(const telltale::AugmentedModel& model) const;

  /// The recalibrated boat with effects.
  telltale::AugmentedModel With(const std::vector<telltale::ModelledEffect>& effects) const;

  const DiagnosisInputs& inputs;
  /// The effects of the library that differ in the mean. An intermittent one has the mean of a
  /// steady one and differs by its scatter, which no baseline counts.
  std::vector<const telltale::Effect*> candidates;
  std::vector<telltale::EffectParameterRef> parameter_refs;
  telltale::FreeRuns runs;
  std::vector<telltale::FreeRuns> reference_runs;
  telltale::NominalBaseline nominal;
  telltale::NoiseFloor floor;
};

}  // namespace blind
