#include "telltale/core/drift/change_equations.hpp"

#include <algorithm>

#include <Eigen/Cholesky>

#include "telltale/core/base/contract.hpp"

namespace telltale {

MarginalChanges::MarginalChanges(const ChangeEquations& equations,
                                 const Eigen::VectorXd& prior_precision)
    : terms_(equations.terms) {
  const Eigen::Index nuisances = prior_precision.size();
  const Eigen::Index changes = equations.projection.size() - nuisances;
  Require(changes > 0 && prior_precision.minCoeff() > 0.0, "a change, and priors of the nuisances");
  const Eigen::MatrixXd across = equations.information.bottomLeftCorner(nuisances, changes);
  const Eigen::VectorXd projection = equations.projection.tail(nuisances);
  const Eigen::LDLT<Eigen::MatrixXd> of_nuisances(
      equations.information.bottomRightCorner(nuisances, nuisances) +
      Eigen::MatrixXd(prior_precision.asDiagonal()));
  const Eigen::VectorXd explained = of_nuisances.solve(projection);
  information_ = equations.information.topLeftCorner(changes, changes) -
                 across.transpose() * of_nuisances.solve(across);
  projection_ = equations.projection.head(changes) - across.transpose() * explained;
  squares_ = equations.squares - projection.dot(explained);
}

ChangeInformation MarginalChanges::Of(Eigen::Index change) const {
  return {std::max(information_(change, change), 0.0), projection_[change]};
}

double MarginalChanges::ResidualVariance() const {
  double most = 0.0;
  for (Eigen::Index c = 0; c < projection_.size(); ++c) {
    if (information_(c, c) > 0.0) {
      most = std::max(most, projection_[c] * projection_[c] / information_(c, c));
    }
  }
  return (squares_ - most) / std::max(terms_, 1.0);
}

}  // namespace telltale
