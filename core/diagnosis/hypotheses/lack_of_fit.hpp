#pragma once

#include "telltale/core/diagnosis/hypotheses/cross_validation.hpp"
#include "telltale/core/diagnosis/hypotheses/diagnosis_problem.hpp"

namespace telltale {

/// Reduced chi-squares of a recording by its ResidualMetric, about one for a nominal boat.
struct LackOfFit {
  double before = 1.0;   ///< of the nominal baseline
  double after = 1.0;    ///< of the likeliest hypothesis, cross-validated
  double nominal = 1.0;  ///< of the references, their geometric mean
  double median = 1.0;   ///< as `after`, of the window that half of the others exceed
  /// ln of the square that the hypothesis leaves over the square that remains once effect sizes
  /// that ridge regression finds on the other fold are subtracted. It is above zero where the same
  /// error recurs in both folds, so that the hypothesis lacks something. It is zero or less where
  /// windows err independently, as in rough weather.
  double predictable = 0.0;
};

/// The lack of fit of the likeliest hypothesis, docs/concepts/diagnosis.md (98). Errors of a
/// stochastic effect are unpredictable: its `after` is its own square, and `predictable` is zero.
LackOfFit AssessLackOfFit(const EffectFit& best, const CrossValidatedErrors& cross_validated,
                          const DiagnosisProblem& problem);

}  // namespace telltale
