#include "telltale/core/identification/tamed_model.hpp"

#include <cmath>
#include <vector>

#include "telltale/core/linear_algebra/covariance.hpp"
#include "telltale/core/linear_algebra/decompositions.hpp"

namespace telltale {
namespace {

/// Places of those that are known to some extent and believed to be anything.
std::vector<Eigen::Index> Drawn(const Identification& identification,
                                const Eigen::VectorXd& sizes) {
  std::vector<Eigen::Index> drawn;
  for (Eigen::Index j = 0; j < sizes.size(); ++j) {
    if (std::isfinite(identification.covariance(j, j)) && sizes[j] > 0.0) drawn.push_back(j);
  }
  return drawn;
}

}  // namespace

Eigen::VectorXd TamedEstimates(const Identification& identification, const Eigen::VectorXd& sizes,
                               const Eigen::VectorXd& believed) {
  Eigen::VectorXd theta = identification.Estimates();
  const std::vector<Eigen::Index> drawn = Drawn(identification, sizes);
  if (drawn.empty()) return theta;
  // With coefficients in units of their believed size: theta' = b + (I + Sigma)^-1 (theta - b).
  const Eigen::VectorXd units = sizes(drawn).cwiseInverse();
  Eigen::MatrixXd sum = Scaled(identification.covariance(drawn, drawn), units);
  sum.diagonal().array() += 1.0;
  const Eigen::VectorXd off = units.cwiseProduct(theta(drawn) - believed(drawn));
  theta(drawn) = believed(drawn) + sizes(drawn).cwiseProduct(sum.ldlt().solve(off));
  return theta;
}

VesselModel TamedModel(const Identification& identification, double trust) {
  Eigen::VectorXd theta = identification.Estimates();
  if (std::isfinite(trust)) {
    theta = TamedEstimates(identification, trust * theta.cwiseAbs(),
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
