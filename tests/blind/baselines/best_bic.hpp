#pragma once

#include <vector>

#include "baselines/scored_explanation.hpp"

namespace blind::baselines {

/// Every effect that moves free runs, alone, by least squares on their errors, whitened by the
/// nominal covariance of a window: bic = n ln(S / n) + k ln n of n errors with sum of squares S and
/// k parameters (Schwarz 1978). Names one always; effects that only shake are none of them.
std::vector<ScoredExplanation> BestBic(const ReferenceBasis& basis);

}  // namespace blind::baselines
