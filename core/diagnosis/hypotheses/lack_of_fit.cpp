#include "telltale/core/diagnosis/hypotheses/lack_of_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"

namespace telltale {
namespace {

constexpr double kPriorEffectSd = 0.3;  // of typical ones: what a remainder may hold of each effect

/// Sizes of all slots that the remainder on the judge's windows asks for, by ridge. What scatters
/// more than in health tells less.
Eigen::VectorXd RidgeEstimate(const Eigen::MatrixXd& errors, const ResidualMetric& metric,
                              const Sensitivity& recording) {
  const Eigen::VectorXd left = metric.Whiten(errors);
  const Eigen::MatrixXd seen = metric.WhitenColumns(recording.by_effect_parameter);
  const Eigen::MatrixXd weighed = metric.Marginalise(seen);
  const double scatter = std::max(metric.ReducedChiSquare(left), 1.0);
  Eigen::MatrixXd information = seen.transpose() * weighed / scatter;
  information.diagonal().array() += 1.0 / (kPriorEffectSd * kPriorEffectSd);
  const Eigen::VectorXd slope = weighed.transpose() * left / scatter;
  return -information.ldlt().solve(slope);
}

double PredictableIn(const Eigen::MatrixXd& errors, const EffectFit& best,
                     const DiagnosisProblem& problem) {
  const std::array metrics = {best.WidenedMetric(MetricOfFold(problem, 0)),
                              best.WidenedMetric(MetricOfFold(problem, 1))};
  double left = 0.0;
  double less = 0.0;
  for (std::size_t fold = 0; fold < kFolds; ++fold) {
    const Eigen::VectorXd sizes = RidgeEstimate(errors, metrics[1 - fold], problem.recording);
    const ResidualMetric& metric = metrics[fold];
    const Eigen::VectorXd seen = metric.Whiten(errors);
    left += metric.SquaredMahalanobis(seen);
    less += metric.SquaredMahalanobis(
        seen + metric.WhitenColumns(problem.recording.by_effect_parameter) * sizes);
  }
  return std::log(left / less);
}

}  // namespace

LackOfFit AssessLackOfFit(const EffectFit& best, const CrossValidatedErrors& cross_validated,
                          const DiagnosisProblem& problem) {
  const ResidualMetric& metric = problem.metric;
  const auto& logs = problem.nominal.log_reduced_chi_squares;
  const double mean =
      std::accumulate(logs.begin(), logs.end(), 0.0) / static_cast<double>(logs.size());
  LackOfFit lack_of_fit{.before = metric.ReducedChiSquare(metric.Whiten(problem.recording.errors)),
                        .nominal = std::exp(mean)};
  // What only shakes leaves errors as they are, and windows that scatter: nothing to learn from.
  if (best.effects.back().effect->IsStochastic()) {
    lack_of_fit.after = best.square / metric.ExpectedSquare();
    return lack_of_fit;
  }
  const ResidualMetric widened = best.WidenedMetric(metric);
  lack_of_fit.after = widened.ReducedChiSquare(widened.Whiten(cross_validated.errors));
  lack_of_fit.predictable = PredictableIn(cross_validated.errors, best, problem);
  return lack_of_fit;
}

}  // namespace telltale
