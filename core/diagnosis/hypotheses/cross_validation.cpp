#include "telltale/core/diagnosis/hypotheses/cross_validation.hpp"

#include <algorithm>

#include "telltale/core/diagnosis/hypotheses/refit.hpp"
#include "telltale/core/diagnosis/hypotheses/stochastic_excitation.hpp"

namespace telltale {

std::vector<std::size_t> FoldsOf(const FreeRuns& runs) {
  const std::vector<std::size_t> blocks = BlocksOf(runs);
  std::vector<std::size_t> folds(blocks.size());
  for (std::size_t w = 1; w < folds.size(); ++w) {
    folds[w] = blocks[w] == blocks[w - 1] ? folds[w - 1] : (folds[w - 1] + 1) % kFolds;
  }
  return folds;
}

std::vector<std::size_t> WindowsOf(const std::vector<std::size_t>& folds, std::size_t fold) {
  std::vector<std::size_t> windows;
  for (std::size_t w = 0; w < folds.size(); ++w) {
    if (folds[w] == fold) windows.push_back(w);
  }
  return windows;
}

ResidualMetric MetricOfFold(const DiagnosisProblem& problem, std::size_t fold) {
  return {problem.nominal, problem.recording, WindowsOf(FoldsOf(problem.runs), fold),
          problem.metric.FreesCoefficients()};
}

FoldFits FitOnFolds(const EffectFit& fit, const DiagnosisProblem& problem) {
  FoldFits fits;
  for (std::size_t fold = 0; fold < kFolds; ++fold) {
    fits[fold] = Refit(fit, problem, MetricOfFold(problem, fold));
  }
  return fits;
}

CrossValidatedErrors CrossValidatedErrorsOf(const FoldFits& fits, const FreeRuns& runs,
                                            const AugmentedModel& model) {
  const auto folds = FoldsOf(runs);
  CrossValidatedErrors cross_validated;
  cross_validated.errors.resize(runs.Rows(), static_cast<Eigen::Index>(runs.Windows()));
  for (std::size_t fold = 0; fold < kFolds; ++fold) {
    const Eigen::MatrixXd errors = runs.Errors(model.With(fits[fold].effects));
    for (std::size_t w = 0; w < folds.size(); ++w) {
      if (folds[w] == fold) continue;
      cross_validated.errors.col(static_cast<Eigen::Index>(w)) =
          errors.col(static_cast<Eigen::Index>(w));
    }
    cross_validated.stochastic_mean_squares[fold] = StochasticMeanSquares(fits[fold], runs, model);
  }
  return cross_validated;
}

Eigen::VectorXd CrossValidatedSquaredGaps(const CrossValidatedErrors& cross_validated,
                                          const FreeRuns& runs, const NoiseFloor& floor,
                                          int channel) {
  Eigen::VectorXd gaps = SquaredGaps(cross_validated.errors, floor.scale, channel);
  const double excess = std::max(gaps.mean() - floor.Squared(channel), 0.0);
  const auto folds = FoldsOf(runs);
  for (std::size_t fold = 0; fold < kFolds; ++fold) {
    // SquaredGaps takes errors: the roots stand for one window with these mean squares.
    const Eigen::VectorXd root_mean_squares =
        cross_validated.stochastic_mean_squares[fold].cwiseMax(0.0).cwiseSqrt();
    const double explained =
        std::min(SquaredGaps(root_mean_squares, floor.scale, channel)[0], excess);
    for (std::size_t w = 0; w < folds.size(); ++w) {
      if (folds[w] != fold) gaps[static_cast<Eigen::Index>(w)] -= explained;
    }
  }
  return gaps;
}

}  // namespace telltale
