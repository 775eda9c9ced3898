#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/diagnosis/baseline/residual_metric.hpp"
#include "telltale/core/diagnosis/hypotheses/effect_posterior.hpp"
#include "telltale/core/diagnosis/residuals/free_runs.hpp"
#include "telltale/core/effects/augmented_model.hpp"

namespace telltale {

/// Effects fitted together to a recording's free runs.
struct EffectFit {
  std::vector<ModelledEffect> effects;
  Eigen::MatrixXd covariance;  ///< of all values, stacked in the order of the effects
  /// -2 ln of the evidence (Laplace) less that of no effect at all. Negative where the effects are
  /// likelier than none.
  double score = 0.0;
  double square = 0.0;     ///< squared Mahalanobis distance of the errors that are left
  Eigen::MatrixXd errors;  ///< rows x windows, with the effects
  /// What gusts and drifts do to the errors: of each parameter that gusts one column for each
  /// course of a gust through a window, of each that drifts one. Empty where nothing does.
  ErrorVariation variation;
  /// The scatter of the size of an intermittent effect, in its unit; 0 where there is none.
  double intermittent_sd = 0.0;
  /// The covariance that the stochastic effects add to a window's errors, rows x rows. Empty where
  /// there are none.
  Eigen::MatrixXd scatter;

  std::vector<const Effect*> Effects() const;
  std::vector<std::string> Names() const;
  std::size_t Faults() const;      ///< effects other than weather
  Eigen::VectorXd Values() const;  ///< stacked
  /// The effects that are not stochastic, with their values alone.
  EffectFit Deterministic() const;
  /// Half the squared distance, in standard deviations, of shape parameters from their prior means.
  /// It is large where an effect imitates another. Of stochastic effects any shape is as likely.
  double NegativeLogPrior() const;

  const Effect* Stochastic() const;  ///< the stochastic effect, which stands last; or null
  /// `metric`, allowing for the scatter of the stochastic effects among these.
  ResidualMetric ScatteredMetric(const ResidualMetric& metric) const;
  /// The same, allowing for gusts and drifts too.
  ResidualMetric WidenedMetric(const ResidualMetric& metric) const;
};

/// The free-run errors of `boat` with effects. The free runs and the boat have to outlive it.
ErrorModel ErrorModelOf(const FreeRuns& runs, const AugmentedModel& boat);

/// Most probable values of effects that act together, and their evidence by Laplace's method,
/// docs/concepts/diagnosis.md (88), (89), (97). Priors are normal: of twice the typical size about
/// zero, and for a shape parameter of its spread about its prior mean. Levenberg-Marquardt runs
/// from each of `starts`, a stack of values each; the lowest cost is kept. What
/// gusts or drifts is fitted again allowing for that, where it lowers the score. An intermittent
/// effect is fitted with the likeliest scatter; where it scatters less than that it is the less
/// likely, and where the other effects leave its mean open it is no likelier than none. Requires:
/// at least one effect and one start.
EffectFit FitEffects(const ErrorModel& error_model, const ResidualMetric& metric,
                     const std::vector<const Effect*>& effects,
                     const std::vector<Eigen::VectorXd>& starts);

}  // namespace telltale
