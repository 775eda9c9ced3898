#pragma once

#include <Eigen/Core>

namespace telltale {

/// Weighted least squares, of as many windows as are added: information times unknowns =
/// projection. Shapes: n x n, n.
struct ChangeEquations {
  Eigen::MatrixXd information;
  Eigen::VectorXd projection;
  double squares = 0.0;  ///< weighted, where all unknowns are zero
  double terms = 0.0;    ///< independent terms of them

  static ChangeEquations OfZeros(Eigen::Index unknowns) {
    return {Eigen::MatrixXd::Zero(unknowns, unknowns), Eigen::VectorXd::Zero(unknowns)};
  }

  void Add(const ChangeEquations& more) {
    information += more.information;
    projection += more.projection;
    squares += more.squares;
    terms += more.terms;
  }
};

/// What the equations say of one unknown: its precision, and its estimate times that.
struct ChangeInformation {
  double precision = 0.0;
  double projection = 0.0;

  double Value() const { return projection / precision; }
};

/// Equations without their nuisances, which come last and may be anything within their priors.
/// Model: A_cc - A_cn (A_nn + P)^-1 A_nc for each change c alone, the others being zero.
/// Requires: `prior_precision`, P, of all nuisances, each > 0.
class MarginalChanges {
 public:
  MarginalChanges(const ChangeEquations& equations, const Eigen::VectorXd& prior_precision);

  ChangeInformation Of(Eigen::Index change) const;

  /// The variance of unit weight that the nuisances and the change that explains most leave: 1
  /// where the errors are as large as the weights say.
  double ResidualVariance() const;

 private:
  Eigen::MatrixXd information_;  ///< by change
  Eigen::VectorXd projection_;
  double squares_;  ///< that the nuisances leave
  double terms_;
};

}  // namespace telltale
