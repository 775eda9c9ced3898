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

/// Derivatives of one equation's right side by unknowns that all equations share. They serve as
/// instruments, multiplied by the equation's weight. No columns: not sought.
struct SharedDerivatives {
  Eigen::MatrixXd by_lag;    ///< one column, by the time constant
  Eigen::MatrixXd by_delay;  ///< a column a delay, DelayDerivatives
};

/// How many unknowns there are of each kind, in the order in which they are stacked: the change of
/// the time constant, if that is sought, the coefficients, and the delays, if sought.
struct StackedUnknowns {
  Eigen::Index lags = 0;
  Eigen::Index coefficients = 0;  ///< of all equations
  Eigen::Index delays = 0;

  Eigen::Index Count() const { return lags + coefficients + delays; }
};

/// The linear system A x = c of all equations about the present estimate. The equations are added
/// one by one, so that their whitened sides need not stand in memory together.
class StackedSystem {
 public:
  StackedSystem() = default;
  explicit StackedSystem(const StackedUnknowns& unknowns);

  /// Adds the next equation, which has as many derivatives as there are shared unknowns.
  void Add(const ProjectedEquation& equation, const Eigen::MatrixXd& Z,
           const SharedDerivatives& shared, double weight);

  Eigen::MatrixXd A;                       ///< Z'G
  Eigen::VectorXd c;                       ///< Z'b
  std::vector<StackedEquation> equations;  ///< in the order in which they are added

 private:
  StackedUnknowns unknowns_;
  Eigen::Index next_ = 0;  ///< where the next equation's coefficients begin
};

/// A^-1, computed with rows and columns scaled; nothing when A is singular or not finite.
std::optional<Eigen::MatrixXd> InvertScaled(const Eigen::MatrixXd& A);

/// Distributes stacked unknowns, from `first` on, to the equations.
void UnstackThetas(const Eigen::VectorXd& stacked, Eigen::Index first, Thetas& thetas);

}  // namespace telltale
