#include "telltale/core/drift/change_estimate.hpp"

#include <cmath>
#include <utility>

#include <Eigen/Cholesky>

#include "telltale/core/base/contract.hpp"

namespace telltale {

ChangeEstimate::ChangeEstimate(Eigen::VectorXd prior_precision, double forgetting)
    : prior_precision_(std::move(prior_precision)),
      forgetting_(forgetting),
      sum_{Eigen::MatrixXd::Zero(prior_precision_.size(), prior_precision_.size()),
           Eigen::VectorXd::Zero(prior_precision_.size())},
      scatter_(sum_.information),
      unknowns_(sum_.projection) {
  Require(prior_precision_.size() > 0 && prior_precision_.minCoeff() > 0.0, "prior precisions > 0");
  Require(forgetting > 0.0 && forgetting < 1.0, "forgetting in (0, 1)");
}

void ChangeEstimate::Add(const NormalEquations& equations) {
  const Eigen::VectorXd surprise = equations.projection - equations.information * unknowns_;
  scatter_ = forgetting_ * forgetting_ * scatter_ + surprise * surprise.transpose();
  sum_.information = forgetting_ * sum_.information + equations.information;
  sum_.projection = forgetting_ * sum_.projection + equations.projection;
  count_ = forgetting_ * count_ + 1.0;
  unknowns_ = Information().ldlt().solve(sum_.projection);
}

double ChangeEstimate::StandardError() const {
  const Eigen::VectorXd first =
      Information().ldlt().solve(Eigen::VectorXd::Unit(prior_precision_.size(), 0));
  Eigen::VectorXd nuisances = prior_precision_;
  nuisances[0] = 0.0;
  return std::sqrt(first.dot(scatter_ * first) + first.dot(nuisances.asDiagonal() * first));
}

Eigen::MatrixXd ChangeEstimate::Information() const {
  return sum_.information + Eigen::MatrixXd(prior_precision_.asDiagonal());
}

}  // namespace telltale
