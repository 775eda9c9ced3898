#include "telltale/core/estimation/output_error/output_error_covariance.hpp"

#include <algorithm>
#include <cmath>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/base/linear_algebra/covariance.hpp"
#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"

namespace telltale {

Eigen::MatrixXd ClusterCovariance(const OutputErrorFit& fit) {
  // A cluster that alone determines some direction leaves this share of its information.
  constexpr double kLeastLeft = 0.02;
  const Eigen::MatrixXd& root = fit.separability.root;
  const Eigen::MatrixXd across = root.transpose();
  const auto g = static_cast<double>(fit.scores.cols());
  Require(g > 1.0, "at least two clusters");
  Eigen::MatrixXd influence(root.rows(), fit.scores.cols());
  for (Eigen::Index s = 0; s < fit.scores.cols(); ++s) {
    // (H - H_s)^-1 q_s = root (1 - root' H_s root)^-1 root' q_s, within the separable directions.
    Eigen::MatrixXd left =
        (kLeastLeft - 1.0) * Mapped(across, fit.cluster_information[static_cast<std::size_t>(s)]);
    left.diagonal().array() += 1.0;
    const Eigen::VectorXd right = across * fit.scores.col(s);
    influence.col(s) = root * left.llt().solve(right);
  }
  return (g - 1.0) / g * OfRoot(influence);
}

Eigen::MatrixXd NaiveCovariance(const OutputErrorFit& fit) {
  return fit.residual_variance * OfRoot(fit.separability.root);
}

double Misspecification(const OutputErrorFit& fit) {
  const Eigen::VectorXd clustered = ClusterCovariance(fit).diagonal();
  const Eigen::VectorXd naive = NaiveCovariance(fit).diagonal();
  double worst = 0.0;
  for (const Equation equation : kEquations) {
    const Eigen::Index first = fit.unknowns.First(equation);
    const auto size = static_cast<Eigen::Index>(fit.unknowns.columns[IndexOf(equation)].size());
    double sum = 0.0;
    double count = 0.0;
    for (Eigen::Index j = first; j < first + size; ++j) {
      if (!fit.separability.separable[static_cast<std::size_t>(j)]) continue;
      sum += 0.5 * std::log(clustered[j] / naive[j]);
      count += 1.0;
    }
    if (count > 0.0) worst = std::max(worst, std::exp(sum / count));
  }
  return worst;
}

}  // namespace telltale
