#pragma once

#include <vector>

#include "baselines/scored_explanation.hpp"

namespace blind::baselines {

/// Both regress the acceleration residuals of the recalibrated boat on the signatures of
/// effects, all parameters of an effect together, sizes within the effect's range; up to three
/// effects. bic = n ln(S / m) + k ln n, with n the independent ones of m misses. Nothing at all is
/// an answer.

/// Forward: adds the effect that lowers the criterion most, as long as one does and brings at least
/// a tenth of what is explained with it (Draper and Smith 1998, chapter 15).
std::vector<ScoredExplanation> Stepwise(const ReferenceBasis& basis);

/// Sequentially thresholded ridge regression (Brunton, Proctor and Kutz 2016; Rudy et al. 2017):
/// all effects at once, those below a share of their typical size dropped, fitted again until none
/// is; of all such shares the support with the least criterion.
std::vector<ScoredExplanation> Sparse(const ReferenceBasis& basis);

}  // namespace blind::baselines
