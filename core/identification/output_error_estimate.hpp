#pragma once

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/output_error/output_error.hpp"
#include "telltale/core/estimation/regression/regression_problem.hpp"
#include "telltale/core/identification/equation_estimates.hpp"
#include "telltale/core/identification/identify.hpp"

namespace telltale {

/// Above this misspecification ratio bounds of output error are not believed,
/// docs/concepts/model.md (54).
inline constexpr double kLargestAcceptedMisspecification = 1.3;

/// Output error on the columns that one-step regressions of the same rows excite.
struct FittedOutputError {
  EquationEstimates equation_estimates;  ///< excitations and refusals so far
  OutputErrorFit fit;
  double misspecification = 0.0;

  /// Whether what keeps model and measurement apart is the sensors' noise alone.
  bool IsWellSpecified() const;
};

/// `answers`: of AssessExcitation. `start`: where to begin; the damped estimate of weak-form IV if
/// there is none. Refuses when: an equation cannot be answered, as all three are sailed at once, or
/// EstimateOutputError does.
Result<FittedOutputError> FitOutputError(const PreparedDataset& dataset,
                                         const RegressionOptions& regression,
                                         EquationEstimates equation_estimates,
                                         const std::optional<VesselModel>& start = std::nullopt);

/// Its coefficients with bounds by the cluster sandwich, and by profile likelihood where that is
/// badly lopsided and the fit believable. One that is part of an inseparable direction is COLLINEAR
/// and unbounded, one that nothing measured moves with NOT_EXCITED; refusals name the directions.
/// Requires: dataset and regression that were fitted.
BoundedEstimates BoundsOf(FittedOutputError fitted, const PreparedDataset& dataset,
                          const RegressionOptions& regression, const IdentifyOptions& options);

/// Both at once. Refuses when: FitOutputError does.
Result<BoundedEstimates> BoundOutputError(const PreparedDataset& dataset,
                                          const RegressionOptions& regression,
                                          const IdentifyOptions& options, const Progress& progress);

}  // namespace telltale
