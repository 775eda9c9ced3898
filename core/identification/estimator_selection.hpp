#pragma once

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/regression/regression_problem.hpp"
#include "telltale/core/identification/equation_estimates.hpp"
#include "telltale/core/identification/identify.hpp"

namespace telltale {

/// Output error where its bounds hold, weak-form instrumental variables everywhere else;
/// docs/concepts/model.md (54), (55). Two questions, the cheap one first:
///   do the weak form's residuals exceed plainly what sensors leave? (ResidualVarianceRatio)
///   does output error leave anything but the sensors' noise? (Misspecification)
/// Output error is chosen on two clear noes; doubt of any kind, a fit that does not converge, an
/// equation that cannot be answered or a direction that cannot be told apart, is answered by the
/// weak form. The provenance says in a sentence what was chosen and why.
/// Refuses when: BoundWeakIv does.
Result<BoundedEstimates> BoundWithSelectedEstimator(const PreparedDataset& dataset,
                                                    const RegressionOptions& regression,
                                                    const IdentifyOptions& options,
                                                    const Progress& progress);

}  // namespace telltale
