#pragma once

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/regression/regression_problem.hpp"
#include "telltale/core/identification/equation_estimates.hpp"
#include "telltale/core/identification/identify.hpp"

namespace telltale {

/// Output error where its bounds hold, weak-form instrumental variables elsewhere;
/// docs/concepts/model.md (54), (55). Two tests, the cheap one first:
///   whether the weak form's residuals exceed the sensors' part (ResidualVarianceRatio),
///   whether output error leaves more than the sensors' noise (Misspecification).
/// Output error is chosen where neither holds. The weak form is chosen in all other cases: a fit
/// that does not converge, an equation that cannot be estimated, an inseparable direction. The
/// provenance gives choice and reason in a sentence.
/// Refuses when: BoundWeakIv does.
Result<BoundedEstimates> BoundWithSelectedEstimator(const PreparedDataset& dataset,
                                                    const RegressionOptions& regression,
                                                    const IdentifyOptions& options,
                                                    const Progress& progress);

}  // namespace telltale
