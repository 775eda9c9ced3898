#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/diagnosis/hypotheses/hypothesis_search.hpp"
#include "telltale/core/diagnosis/residuals/gap.hpp"

namespace telltale {

/// Blocks of half a minute in turn belong to the one fold and the other: what was fitted on one is
/// judged on the other. Both see the whole recording, its weather and what changes along it. Blocks
/// without a window take no turn, so that neither fold is empty however a recording is torn.
inline constexpr std::size_t kFolds = 2;
std::vector<std::size_t> FoldsOf(const FreeRuns& runs);

/// The windows of one of them.
std::vector<std::size_t> WindowsOf(const std::vector<std::size_t>& folds, std::size_t fold);

/// Of what one fold's windows say alone.
ResidualMetric MetricOfFold(const DiagnosisProblem& problem, std::size_t fold);

/// An explanation fitted on each fold's windows alone.
using FoldFits = std::array<EffectFit, kFolds>;
FoldFits FitOnFolds(const EffectFit& fit, const DiagnosisProblem& problem);

/// Errors of a model with the effects, each window's by the fit that did not see it; how much the
/// effects that shake add to the mean square of each row comes apart.
struct CrossValidatedErrors {
  Eigen::MatrixXd errors;
  std::array<Eigen::VectorXd, kFolds> stochastic_mean_squares;
};
CrossValidatedErrors CrossValidatedErrorsOf(const FoldFits& fits, const FreeRuns& runs,
                                            const AugmentedModel& model);

/// SquaredGaps of held-out errors, less what shaking explains.
Eigen::VectorXd CrossValidatedSquaredGaps(const CrossValidatedErrors& cross_validated,
                                          const FreeRuns& runs, const NoiseFloor& floor,
                                          int channel);

}  // namespace telltale
