#pragma once

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/output_error/output_error.hpp"
#include "telltale/core/estimation/regression/regression_problem.hpp"
#include "telltale/core/identification/equation_estimates.hpp"
#include "telltale/core/identification/identify.hpp"

namespace telltale {

/// Above this misspecification ratio the bounds of output error are not accepted,
/// docs/concepts/model.md (54).
inline constexpr double kLargestAcceptedMisspecification = 1.3;

/// Output error on the columns that one-step regressions of the same rows excite.
struct FittedOutputError {
  EquationEstimates equation_estimates;  ///< excitations and refusals
  OutputErrorFit fit;
  double misspecification = 0.0;

  /// Whether sensor noise alone explains the difference between model and measurement.
  bool IsWellSpecified() const;
};

/// `equation_estimates`: of AssessExcitation. `start`: initial model; the regularised estimate of
/// weak-form IV if there is none. Refuses when: an equation cannot be estimated, since all three
/// are simulated together, or EstimateOutputError does.
Result<FittedOutputError> FitOutputError(const PreparedDataset& dataset,
                                         const RegressionOptions& regression,
                                         EquationEstimates equation_estimates,
                                         const std::optional<VesselModel>& start = std::nullopt);

/// Its coefficients with bounds by the cluster sandwich, and by profile likelihood where that is
/// strongly asymmetric and the fit well specified. A coefficient in an inseparable direction is
/// COLLINEAR and unbounded; one without effect on the measurements is NOT_EXCITED. Refusals name
/// the directions. Requires: dataset and regression that were fitted.
BoundedEstimates BoundsOf(FittedOutputError fitted, const PreparedDataset& dataset,
                          const RegressionOptions& regression, const IdentifyOptions& options);

/// Both at once. Refuses when: FitOutputError does.
Result<BoundedEstimates> BoundOutputError(const PreparedDataset& dataset,
                                          const RegressionOptions& regression,
                                          const IdentifyOptions& options, const Progress& progress);

}  // namespace telltale
