#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/diagnosis/residuals/free_runs.hpp"
#include "telltale/core/effects/effect.hpp"
#include "telltale/core/identification/uncertain_model.hpp"

namespace telltale {

/// One parameter of one effect that is zero in a nominal boat.
struct EffectParameterRef {
  const Effect* effect = nullptr;
  std::size_t parameter = 0;
};

/// The parameters of effects that move free runs. Stochastic effects have none.
std::vector<EffectParameterRef> EffectParameterRefsOf(std::span<const Effect* const> effects);

/// The columns of an effect's parameters; none for a stochastic effect.
std::vector<Eigen::Index> ColumnsOf(const Effect& effect,
                                    const std::vector<EffectParameterRef>& parameter_refs);

/// The effect with this parameter at `value`, the others at their prior means.
ModelledEffect At(const EffectParameterRef& parameter_ref, double value);

/// The effects of these parameters. Shapes: sizes in typical sizes, one per parameter.
std::vector<ModelledEffect> EffectsOf(const std::vector<EffectParameterRef>& parameter_refs,
                                      const Eigen::VectorXd& sizes);

/// Errors of a recording and how they change with the model's free parameters, in their standard
/// errors, and with each effect parameter, in typical sizes. Shapes: errors rows x windows; the
/// others one column an unknown, errors stacked window by window; window_times_s the start of each
/// window.
struct Sensitivity {
  Eigen::MatrixXd errors;
  Eigen::MatrixXd by_coefficient;
  Eigen::MatrixXd by_effect_parameter;
  std::vector<double> window_times_s = {};
};

/// A boat that a model is of, and by how many standard errors its free parameters differ from the
/// model's.
struct ChangedBoat {
  AugmentedModel boat;
  Eigen::VectorXd change;
};

/// About `about`, a boat of `model`. Secants over one standard error of a free parameter and `step`
/// typical sizes of an effect's more than the boat has: effects with thresholds have no slope at
/// zero.
Sensitivity SensitivityOf(const FreeRuns& runs, const ChangedBoat& about,
                          const UncertainModel& model,
                          const std::vector<EffectParameterRef>& parameter_refs,
                          std::size_t threads, double step = 1.0);

}  // namespace telltale
