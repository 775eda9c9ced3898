#include "telltale/core/diagnosis/hypotheses/scatter_fit.hpp"

#include <algorithm>
#include <cmath>

#include "telltale/core/base/linear_algebra/covariance.hpp"
#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/diagnosis/diagnosis_constants.hpp"
#include "telltale/core/diagnosis/residuals/gap.hpp"

namespace telltale {
namespace {

Eigen::MatrixXd CovarianceWith(const Eigen::Vector3d& squared_amplitudes,
                               const ResponseMoments& moments) {
  const Eigen::Index rows = moments[0].rows();
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(rows, rows);
  return identity + ExcessCovariance(squared_amplitudes, moments);
}

/// Each axis alone with a share of the scatter.
Eigen::Vector3d InitialSquaredAmplitudes(const Eigen::MatrixXd& moment,
                                         const ResponseMoments& moments) {
  Eigen::Vector3d squared_amplitudes;
  for (std::size_t j = 0; j < 3; ++j) {
    squared_amplitudes[static_cast<Eigen::Index>(j)] =
        kDiagnosis.stochastic_excitation.initial_share * moment.trace() /
        std::max(moments[j].trace(), 1e-12);
  }
  return squared_amplitudes;
}

void ScoreOnce(const Eigen::MatrixXd& moment, const ResponseMoments& moments,
               Eigen::Vector3d& squared_amplitudes) {
  const Eigen::MatrixXd inverse = Inverse(CovarianceWith(squared_amplitudes, moments));
  const Eigen::MatrixXd observed = Mapped(inverse, moment);
  for (std::size_t j = 0; j < 3; ++j) {
    const double wanted = (observed.array() * moments[j].array()).sum();
    const double expected = (inverse.array() * moments[j].array()).sum();
    squared_amplitudes[static_cast<Eigen::Index>(j)] *=
        std::sqrt(wanted / std::max(expected, 1e-300));
  }
}

}  // namespace

Eigen::MatrixXd ExcessCovariance(const Eigen::Vector3d& squared_amplitudes,
                                 const ResponseMoments& moments) {
  return squared_amplitudes[0] * moments[0] + squared_amplitudes[1] * moments[1] +
         squared_amplitudes[2] * moments[2];
}

ScatterFit FitScatter(const Eigen::MatrixXd& windows, const ResponseMoments& moments) {
  const Eigen::MatrixXd moment = OfRoot(windows) / static_cast<double>(windows.cols());
  ScatterFit fit;
  fit.squared_amplitudes = InitialSquaredAmplitudes(moment, moments);
  for (int i = 0; i < kDiagnosis.stochastic_excitation.iterations; ++i) {
    ScoreOnce(moment, moments, fit.squared_amplitudes);
  }
  const Eigen::LLT<Eigen::MatrixXd> factor(CovarianceWith(fit.squared_amplitudes, moments));
  const double log_determinant = 2.0 * factor.matrixLLT().diagonal().array().log().sum();
  const Eigen::VectorXd squares = factor.matrixL().solve(windows).colwise().squaredNorm();
  fit.square = squares.sum();
  fit.log_likelihood_ratios = windows.colwise().squaredNorm().transpose() - squares;
  fit.log_likelihood_ratios.array() -= log_determinant;
  return fit;
}

double PersistentSum(const Eigen::VectorXd& values, const std::vector<std::size_t>& blocks) {
  std::vector<double> means;
  for (const auto& [sum, count] :
       SumsByBlock(values, Eigen::VectorXd::Ones(values.size()), blocks)) {
    means.push_back(sum / count);
  }
  const auto quarter = means.begin() + std::ssize(means) / 4;
  std::nth_element(means.begin(), quarter, means.end());
  return *quarter * static_cast<double>(values.size());
}

}  // namespace telltale
