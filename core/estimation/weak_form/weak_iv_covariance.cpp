#include "telltale/core/estimation/weak_form/weak_iv_covariance.hpp"

#include "telltale/core/base/contract.hpp"
#include "telltale/core/base/linear_algebra/covariance.hpp"
#include "telltale/core/estimation/regression/residual_autocovariance.hpp"

namespace telltale {

Eigen::MatrixXd StationaryMeat(const WeakProblem& problem, std::size_t equation,
                               const Eigen::VectorXd& residual, const Eigen::MatrixXd& Z) {
  const auto runs = RunsOf(problem.supports[equation].first_rows, problem.phi.stride);
  return Z.transpose() *
         Correlate(runs, DefiniteAutocovariance(runs, residual, kSupportResidualLags), Z);
}

Eigen::MatrixXd ClusterCovariance(const WeakFit& fit) {
  const auto g = static_cast<double>(fit.scores.cols());
  const auto p = static_cast<double>(fit.theta.size());
  Require(g > 1.0, "at least two clusters");
  const Eigen::MatrixXd influence = fit.bread * fit.scores;
  const Eigen::MatrixXd clustered = g / (g - 1.0) * OfRoot(influence);
  const double scale =
      clustered.diagonal().cwiseQuotient(fit.stationary_covariance.diagonal()).mean();
  return g / (p + g) * clustered + p / (p + g) * scale * fit.stationary_covariance;
}

}  // namespace telltale
