#pragma once

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/output_error.hpp"
#include "telltale/core/estimation/regression_problem.hpp"
#include "telltale/core/identification/answers.hpp"
#include "telltale/core/identification/identify.hpp"
#include "telltale/core/result.hpp"

namespace telltale {

/// Above this misspecification ratio bounds of output error are not believed, docs/model.md (54).
inline constexpr double kBelievedMisspecification = 1.3;

/// Output error on the columns that one-step regressions of the same rows excite.
struct FittedOutputError {
  Answers answers;  ///< excitations and refusals so far
  OutputErrorFit fit;
  double misspecification = 0.0;

  /// Whether what keeps model and measurement apart is the sensors' noise alone.
  bool Believable() const;
};

/// `answers`: of AssessAll. `start`: where to begin; the damped estimate of weak-form IV if there
/// is none.
/// Refuses when: an equation cannot be answered, as all three are sailed at once, or
/// EstimateOutputError does.
Result<FittedOutputError> FitOutputError(const PreparedDataset& dataset,
                                         const RegressionOptions& regression, Answers answers,
                                         const std::optional<VesselModel>& start = std::nullopt);

/// Its coefficients with bounds by the cluster sandwich, and by profile likelihood where that is
/// badly lopsided and the fit believable. One that is part of an inseparable direction is COLLINEAR
/// and unbounded, one that nothing measured moves with NOT_EXCITED; refusals name the directions.
/// Requires: dataset and regression that were fitted.
BoundedAnswers BoundsOf(FittedOutputError fitted, const PreparedDataset& dataset,
                        const RegressionOptions& regression, const IdentifyOptions& options);

/// Both at once. Refuses when: FitOutputError does.
Result<BoundedAnswers> BoundOutputError(const PreparedDataset& dataset,
                                        const RegressionOptions& regression,
                                        const IdentifyOptions& options, const Progress& progress);

}  // namespace telltale
