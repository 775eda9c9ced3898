#pragma once

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/excitation.hpp"
#include "telltale/core/estimation/regression_problem.hpp"
#include "telltale/core/identification/answers.hpp"
#include "telltale/core/identification/identify.hpp"
#include "telltale/core/result.hpp"

namespace telltale {

/// The answers of one-step least squares, static or lagging, without bounds.
Answers AnswerOneStep(const PreparedDataset& dataset, const RegressionOptions& regression,
                      const ExcitationLimits& limits);

/// The same with bounds by a bootstrap, or from residuals when no replicates are asked for.
/// Refuses when: no equation can be answered, or no replicate solved.
Result<BoundedAnswers> BoundOneStep(const PreparedDataset& dataset,
                                    const RegressionOptions& regression,
                                    const IdentifyOptions& options, const Progress& progress);

}  // namespace telltale
