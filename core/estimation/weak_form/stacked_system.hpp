#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/estimation/weak_form/projected_equations.hpp"

namespace telltale {

/// One equation's part of a stacked system.
struct StackedEquation {
  std::vector<Eigen::Index> places;  ///< of its unknowns among the stacked ones
  Eigen::MatrixXd Z;                 ///< its instruments, in the order of the places
};

/// Derivatives of the right sides by unknowns that all equations share, one matrix an equation.
/// They serve as instruments, multiplied by each equation's weight. Empty: not sought.
struct SharedDerivatives {
  std::vector<Eigen::MatrixXd> by_lag;    ///< one column, by the time constant
  std::vector<Eigen::MatrixXd> by_delay;  ///< a column a delay, DelayDerivatives
};

/// The linear system A x = c of all equations about the present estimate. Its unknowns are the
/// change of the time constant, if that is sought, the coefficients, and the delays, if sought.
struct StackedSystem {
  Eigen::MatrixXd A;                       ///< Z'G
  Eigen::VectorXd c;                       ///< Z'b
  std::vector<StackedEquation> equations;  ///< in the order of the ProjectedEquations
};

StackedSystem StackEquations(const ProjectedEquations& equations,
                             const std::vector<Eigen::MatrixXd>& Z, const SharedDerivatives& shared,
                             const std::vector<double>& weights);

/// A^-1, computed with rows and columns scaled; nothing when A is singular or not finite.
std::optional<Eigen::MatrixXd> InvertScaled(const Eigen::MatrixXd& A);

/// Distributes stacked unknowns, from `first` on, to the equations.
void UnstackThetas(const Eigen::VectorXd& stacked, Eigen::Index first, Thetas& thetas);

}  // namespace telltale
