#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/diagnosis/hypotheses/hypothesis_search.hpp"
#include "telltale/core/diagnosis/residuals/gap.hpp"

namespace telltale {

/// The fold of each window. Blocks of half a minute alternate between two folds: what is fitted to
/// one is assessed on the other. Both span the whole recording, with its weather and its changes.
/// Blocks without a window take no turn, so that gaps in a recording leave neither fold empty.
inline constexpr std::size_t kFolds = 2;
std::vector<std::size_t> FoldsOf(const FreeRuns& runs);

/// The windows of one fold.
std::vector<std::size_t> WindowsOf(const std::vector<std::size_t>& folds, std::size_t fold);

/// The metric of the problem, restricted to one fold's windows.
ResidualMetric MetricOfFold(const DiagnosisProblem& problem, std::size_t fold);

/// A hypothesis fitted to each fold's windows alone.
using FoldFits = std::array<EffectFit, kFolds>;
FoldFits FitOnFolds(const EffectFit& fit, const DiagnosisProblem& problem);

/// Errors of a model with the effects, each window by the fit to the other fold, rows x windows.
/// What stochastic effects add to the mean square of each row stands beside them, by fold of the
/// fit.
struct CrossValidatedErrors {
  Eigen::MatrixXd errors;
  std::array<Eigen::VectorXd, kFolds> stochastic_mean_squares;
};
CrossValidatedErrors CrossValidatedErrorsOf(const FoldFits& fits, const FreeRuns& runs,
                                            const AugmentedModel& model);

/// SquaredGaps of cross-validated errors, less what stochastic excitation explains. Stochastic
/// effects explain no more than the mean excess over the floor.
Eigen::VectorXd CrossValidatedSquaredGaps(const CrossValidatedErrors& cross_validated,
                                          const FreeRuns& runs, const NoiseFloor& floor,
                                          int channel);

}  // namespace telltale
