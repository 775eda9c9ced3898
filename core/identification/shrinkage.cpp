#include "telltale/core/identification/shrinkage.hpp"

#include <cmath>
#include <vector>

#include "telltale/core/base/linear_algebra/covariance.hpp"
#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"

namespace telltale {
namespace {

/// Places of coefficients with a finite variance and a positive prior scale.
std::vector<Eigen::Index> Shrinkable(const Identification& identification,
                                     const Eigen::VectorXd& prior_scales) {
  std::vector<Eigen::Index> shrinkable;
  for (Eigen::Index j = 0; j < prior_scales.size(); ++j) {
    if (std::isfinite(identification.covariance(j, j)) && prior_scales[j] > 0.0)
      shrinkable.push_back(j);
  }
  return shrinkable;
}

}  // namespace

Eigen::VectorXd RegularisedEstimates(const Identification& identification,
                                     const Eigen::VectorXd& prior_scales,
                                     const Eigen::VectorXd& prior_means) {
  Eigen::VectorXd theta = identification.Estimates();
  const std::vector<Eigen::Index> shrinkable = Shrinkable(identification, prior_scales);
  if (shrinkable.empty()) return theta;
  // With coefficients in units of their prior scale: theta' = b + (I + Sigma)^-1 (theta - b).
  const Eigen::VectorXd units = prior_scales(shrinkable).cwiseInverse();
  Eigen::MatrixXd sum = Scaled(identification.covariance(shrinkable, shrinkable), units);
  sum.diagonal().array() += 1.0;
  const Eigen::VectorXd off = units.cwiseProduct(theta(shrinkable) - prior_means(shrinkable));
  theta(shrinkable) =
      prior_means(shrinkable) + prior_scales(shrinkable).cwiseProduct(sum.ldlt().solve(off));
  return theta;
}

VesselModel RegularisedModel(const Identification& identification, double prior_scale) {
  Eigen::VectorXd theta = identification.Estimates();
  if (std::isfinite(prior_scale)) {
    theta = RegularisedEstimates(identification, prior_scale * theta.cwiseAbs(),
                                 Eigen::VectorXd::Zero(theta.size()));
  }
  VesselModel model =
      VesselModel::OfZeros(identification.structure, identification.parameterization,
                           Discretisation::kContinuous, identification.sampling_period_s);
  model.dead_zone = identification.dead_zone;
  if (identification.thruster_time_constant) {
    model.thruster_time_constant_s = identification.thruster_time_constant->estimate;
  }
  Eigen::Index next = 0;
  for (const Equation equation : kEquations) {
    if (!identification.Has(equation)) continue;
    Eigen::VectorXd& of_this = model.theta[IndexOf(equation)];
    of_this = theta.segment(next, of_this.size());
    next += of_this.size();
  }
  return model;
}

}  // namespace telltale
