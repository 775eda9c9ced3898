#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/estimation/weak_form/projected_equations.hpp"

namespace telltale {

/// One equation's part of a stacked system.
struct StackedEquation {
  std::vector<Eigen::Index> places;  ///< of its unknowns among the stacked ones
  Eigen::MatrixXd Z;                 ///< its instruments, that of the time constant first if sought
};

/// The linear system A x = c of all equations about the present estimate. Its unknowns are the
/// change of the time constant, if that is sought, and the coefficients.
struct StackedSystem {
  Eigen::MatrixXd A;                       ///< Z'G
  Eigen::VectorXd c;                       ///< Z'b
  std::vector<StackedEquation> equations;  ///< in the order of the ProjectedEquations
};

/// `by_lag`: derivatives of G theta by the time constant, empty if that is not sought. They serve
/// as its instruments, multiplied by each equation's weight.
StackedSystem StackEquations(const ProjectedEquations& equations,
                             const std::vector<Eigen::MatrixXd>& Z,
                             const std::vector<Eigen::MatrixXd>& by_lag,
                             const std::vector<double>& weights);

/// A^-1, computed with rows and columns scaled; nothing when A is singular or not finite.
std::optional<Eigen::MatrixXd> InvertScaled(const Eigen::MatrixXd& A);

/// Distributes stacked unknowns, from `first` on, to the equations.
void UnstackThetas(const Eigen::VectorXd& stacked, Eigen::Index first, Thetas& thetas);

}  // namespace telltale
