#include "telltale/core/diagnosis/hypotheses/lack_of_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/base/median.hpp"
#include "telltale/core/diagnosis/diagnosis_constants.hpp"

namespace telltale {
namespace {

/// Sizes of all effect parameters, in typical sizes, that ridge regression finds in the errors of
/// the metric's windows. Errors that scatter more than a nominal boat's count for less.
Eigen::VectorXd RidgeEstimate(const Eigen::MatrixXd& errors, const ResidualMetric& metric,
                              const Sensitivity& recording) {
  constexpr double kPriorSd = kDiagnosis.lack_of_fit.prior_effect_sd;
  const Eigen::VectorXd whitened = metric.Whiten(errors);
  const Eigen::MatrixXd columns = metric.WhitenColumns(recording.by_effect_parameter);
  const Eigen::MatrixXd marginalised = metric.Marginalise(columns);
  const double scatter = std::max(metric.ReducedChiSquare(whitened), 1.0);
  Eigen::MatrixXd information = columns.transpose() * marginalised / scatter;
  information.diagonal().array() += 1.0 / (kPriorSd * kPriorSd);
  const Eigen::VectorXd gradient = marginalised.transpose() * whitened / scatter;
  return -information.ldlt().solve(gradient);
}

/// LackOfFit::predictable of the errors.
double PredictableIn(const Eigen::MatrixXd& errors, const EffectFit& best,
                     const DiagnosisProblem& problem) {
  const std::array metrics = {best.WidenedMetric(MetricOfFold(problem, 0)),
                              best.WidenedMetric(MetricOfFold(problem, 1))};
  double square = 0.0;
  double remaining = 0.0;
  for (std::size_t fold = 0; fold < kFolds; ++fold) {
    const Eigen::VectorXd sizes = RidgeEstimate(errors, metrics[1 - fold], problem.recording);
    const ResidualMetric& metric = metrics[fold];
    const Eigen::VectorXd whitened = metric.Whiten(errors);
    square += metric.SquaredMahalanobis(whitened);
    remaining += metric.SquaredMahalanobis(
        whitened + metric.WhitenColumns(problem.recording.by_effect_parameter) * sizes);
  }
  return std::log(square / remaining);
}

/// The median over windows of the mean square of their errors, one a column.
double MedianSquare(const Eigen::MatrixXd& by_window) {
  const Eigen::VectorXd squares = by_window.colwise().squaredNorm().transpose();
  return Median({squares.begin(), squares.end()}) / static_cast<double>(by_window.rows());
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
  const ResidualMetric widened = best.WidenedMetric(metric);
  const Eigen::VectorXd left = widened.Whiten(cross_validated.errors);
  lack_of_fit.after = widened.ReducedChiSquare(left);
  lack_of_fit.median = MedianSquare(widened.UnexplainedByWindow(left));
  lack_of_fit.predictable = PredictableIn(cross_validated.errors, best, problem);
  return lack_of_fit;
}

}  // namespace telltale
