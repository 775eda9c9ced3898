#include "telltale/core/identification/implied_covariance.hpp"

#include <cmath>

namespace telltale {
namespace {

constexpr double kSlopeStep = 1e-3;  // standard errors

}  // namespace

Eigen::MatrixXd ImpliedCovariance(
    const FossenVector& about, const Eigen::MatrixXd& covariance,
    const std::function<Eigen::VectorXd(const FossenVector&)>& implied) {
  const Eigen::VectorXd nominal = implied(about);
  Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(nominal.size(), about.size());
  for (Eigen::Index i = 0; i < about.size(); ++i) {
    if (!(covariance(i, i) > 0.0)) continue;
    const double step = kSlopeStep * std::sqrt(covariance(i, i));
    FossenVector moved = about;
    moved[i] += step;
    slopes.col(i) = (implied(moved) - nominal) / step;
  }
  return slopes * covariance * slopes.transpose();
}

}  // namespace telltale
