#pragma once

#include "data/prepared_dataset.hpp"
#include "estimation/excitation.hpp"
#include "estimation/regression_problem.hpp"
#include "identification/answers.hpp"
#include "identification/identify.hpp"
#include "result.hpp"

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
