#pragma once

#include <cstddef>
#include <vector>

#include "telltale/core/estimation/prediction_error/prediction_error.hpp"

namespace telltale {

/// How one recording differs from the others that made the same fit.
struct RecordingDifference {
  /// The probability that a recording of the same boat moves a parameter as far, over all
  /// parameters (Bonferroni); 1 where nothing is compared.
  double p_value = 1.0;
  /// The parameter that the recording moves most, in standard errors of that move, and its value
  /// without the recording, to first order and within the physical range.
  FossenParameter parameter{};
  double without = 0.0;
};

/// The heterogeneity of recordings: whether they scatter about one boat as their bounds expect.
/// A recording's score at the fit is compared with its covariance by blocks of time, where both the
/// recording and the others inform the parameters.
struct Heterogeneity {
  /// Scatter between the recordings over what their bounds expect: 1 where they are of one boat.
  /// Nothing is compared: 0.
  double birge_ratio = 0.0;
  std::vector<RecordingDifference> recordings;  ///< in the order of the dataset
};

/// Source: Cochran, "The combination of estimates from different experiments", Biometrics 10
/// (1954); Birge, "The calculation of errors by the method of least squares", Physical Review 40
/// (1932); the test by scores is Rao's.
Heterogeneity HeterogeneityOf(const PredictionErrorFit& fit, const FossenPrior& prior);

}  // namespace telltale
