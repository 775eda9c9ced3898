#pragma once

#include <vector>

#include "telltale/core/diagnosis/diagnosis.hpp"
#include "telltale/core/diagnosis/hypotheses/diagnosis_problem.hpp"
#include "telltale/core/effects/effect.hpp"

namespace telltale {

/// The day-to-day distribution of the noise of nominal recordings: ln of their reduced chi-square.
struct NoiseLevels {
  double log_mean = 0.0;
  double log_sd = 0.0;  ///< of one more recording, what the references leave uncertain included
  double degrees_of_freedom = 1.0;
};

/// Student's t over the references that the baseline is of, at least one; of a single one an
/// assumed scatter.
NoiseLevels NoiseLevelsOf(const NominalBaseline& nominal);

/// The probability that one parameter of an effect shows as a material gap,
/// docs/concepts/diagnosis.md (99), (100). `noncentrality`: squared Mahalanobis distance by which
/// it moves the errors; `cost`: what the score has to overcome besides the gate, in -2 ln.
double PowerOf(double noncentrality, double cost, const ResidualMetric& metric,
               const NoiseLevels& noise);

/// The smallest size of each parameter that does not shape, with the others at their prior means,
/// that this recording, model and references show with kDiagnosis.testability.power; of either sign
/// where the range has both. None for a stochastic effect. `nominal_gain`: of NominalGains.
/// Assumes: errors are normal, and what the effect does to them is not masked by another gap.
std::vector<DetectableSize> DetectableSizesOf(const Effect& effect, const DiagnosisProblem& problem,
                                              double nominal_gain);

}  // namespace telltale
