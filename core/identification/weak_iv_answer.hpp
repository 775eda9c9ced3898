#pragma once

#include "data/prepared_dataset.hpp"
#include "estimation/regression_problem.hpp"
#include "identification/answers.hpp"
#include "identification/identify.hpp"
#include "result.hpp"

namespace telltale {

/// How a recording is prepared for the weak form: parts of a minute, whose simulated repeats stay
/// near the data, and the narrowest filter that the noise of the positions allows.
/// Refuses when: Prepare does.
Result<PreparedDataset> PrepareForWeakIv(const Recording& recording, const Vehicle& vehicle,
                                         const PrepareOptions& options);

/// Weak-form instrumental variables on the equations and columns that one-step regressions of the
/// same rows excite, corrected and calibrated by simulated twins.
/// Refuses when: no equation can be answered, or simulated instruments say nothing of the data.
Result<BoundedAnswers> BoundWeakIv(const PreparedDataset& dataset,
                                   const RegressionOptions& regression,
                                   const IdentifyOptions& options, const Progress& progress);

}  // namespace telltale
