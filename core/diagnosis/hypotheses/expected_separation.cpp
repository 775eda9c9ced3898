#include "telltale/core/diagnosis/hypotheses/expected_separation.hpp"

#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/diagnosis/baseline/residual_metric.hpp"
#include "telltale/core/diagnosis/diagnosis_constants.hpp"

namespace telltale {

double ExpectedSeparation(const Eigen::MatrixXd& one, const Eigen::MatrixXd& other,
                          const NominalBaseline& nominal) {
  const Eigen::LLT<Eigen::MatrixXd> factor(nominal.covariance);
  const Eigen::MatrixXd difference = one - other;
  const double expected = static_cast<double>(difference.size());
  const double square = factor.matrixL().solve(difference).squaredNorm();
  const double effective_observations = kDiagnosis.metric.observations_per_window * nominal.kappa *
                                        static_cast<double>(difference.cols());
  return LogEvidenceOf(effective_observations, square / expected);
}

}  // namespace telltale
