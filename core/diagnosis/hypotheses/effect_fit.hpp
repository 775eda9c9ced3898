#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/diagnosis/baseline/residual_metric.hpp"
#include "telltale/core/diagnosis/residuals/free_runs.hpp"
#include "telltale/core/effects/augmented_model.hpp"

namespace telltale {

/// Effects fitted together to a recording's free runs.
struct EffectFit {
  std::vector<ModelledEffect> effects;
  Eigen::MatrixXd covariance;  ///< of all values, stacked
  /// -2 ln of the evidence (Laplace) less that of no effect at all. Negative where the effects are
  /// likelier than none.
  double score = 0.0;
  double square = 0.0;     ///< weighed square of what is left
  Eigen::MatrixXd errors;  ///< rows x windows, with the effects
  /// What gusts do to the errors, one column a standard deviation; none where nothing gusts.
  Eigen::MatrixXd gusts;

  std::vector<const Effect*> Effects() const;
  std::vector<std::string> Names() const;
  Eigen::VectorXd Values() const;  ///< stacked
  /// Half the squared distance, in spreads, of shaping values from where they are usual. Large
  /// where effects are bent to resemble something else.
  double NegativeLogPrior() const;

  /// `judge`, allowing for the gusts that come with these effects.
  ResidualMetric WidenedMetric(const ResidualMetric& metric) const;
};

/// Most probable values of effects acting together, docs/concepts/diagnosis.md (88), (89): each
/// value has a normal prior, of twice its typical size about zero, or of its spread about where it
/// is usual. Levenberg-Marquardt from `starts`, each a stack of values, the best kept. Requires: at
/// least one effect and one start.
EffectFit FitEffects(const FreeRuns& runs, const AugmentedModel& boat, const ResidualMetric& metric,
                     const std::vector<const Effect*>& effects,
                     const std::vector<Eigen::VectorXd>& starts);

/// Where to begin, given what is missed by now: the best linear guess, and both signs of the
/// typical size where the range has them.
std::vector<Eigen::VectorXd> StartsOf(const Effect& effect, const ResidualMetric& metric,
                                      const Eigen::MatrixXd& errors, const Sensitivity& recording,
                                      const std::vector<EffectParameterRef>& parameter_refs);

/// -2 ln of the likelihood that the linear guess promises over that of none; zero at the most.
double ScoreTest(const Effect& effect, const ResidualMetric& metric, const Eigen::MatrixXd& errors,
                 const Sensitivity& recording,
                 const std::vector<EffectParameterRef>& parameter_refs);

}  // namespace telltale
