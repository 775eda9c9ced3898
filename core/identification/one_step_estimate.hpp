#pragma once

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/regression/excitation.hpp"
#include "telltale/core/estimation/regression/regression_problem.hpp"
#include "telltale/core/identification/equation_estimates.hpp"
#include "telltale/core/identification/identify.hpp"

namespace telltale {

/// The estimates of one-step least squares, static or lagging, without bounds.
EquationEstimates EstimateOneStepEquations(const PreparedDataset& dataset,
                                           const RegressionOptions& regression,
                                           const ExcitationLimits& limits);

/// The same with bounds by a bootstrap, or from residuals when no replicates are asked for.
/// Refuses when: no equation can be answered, or no replicate solved.
Result<BoundedEstimates> BoundOneStep(const PreparedDataset& dataset,
                                      const RegressionOptions& regression,
                                      const IdentifyOptions& options, const Progress& progress);

}  // namespace telltale
