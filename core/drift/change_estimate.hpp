#pragma once

#include <Eigen/Core>

namespace telltale {

/// Normal equations of least squares: information times unknowns = projection.
/// Shapes: n x n, n.
struct NormalEquations {
  Eigen::MatrixXd information;
  Eigen::VectorXd projection;
};

/// An unknown that is zero while nothing has changed, beside nuisances that may change at any time.
/// It follows one set of equations after another and forgets exponentially.
/// Model: A = P + sum w_k A_k, b = sum w_k b_k, w_k = forgetting^(n - k); unknowns x = A^-1 b of
/// prior precision P; covariance A^-1 (M + P_0) A^-1 with M = sum w_k^2 r_k r_k' and
/// r_k = b_k - A_k x_{k-1}. P_0 is the part of P that is of the nuisances: where the equations do
/// not tell them from the unknown, its error is as large as they may be.
/// Assumes: errors of different sets are independent. Their size need not be known and may change.
/// Source: White, "A heteroskedasticity-consistent covariance matrix estimator", Econometrica 48
/// (1980).
class ChangeEstimate {
 public:
  /// `prior_precision` of the unknown in question, which comes first, and of the nuisances;
  /// `forgetting` is w_k over w_{k+1}, in (0, 1).
  ChangeEstimate(Eigen::VectorXd prior_precision, double forgetting);

  void Add(const NormalEquations& equations);

  double Value() const { return unknowns_[0]; }
  double StandardError() const;

  /// How many sets of equations count, the forgotten ones less: sum w_k.
  double Count() const { return count_; }

 private:
  Eigen::MatrixXd Information() const;

  Eigen::VectorXd prior_precision_;
  double forgetting_;
  double count_ = 0.0;
  NormalEquations sum_;
  Eigen::MatrixXd scatter_;  ///< M
  Eigen::VectorXd unknowns_;
};

}  // namespace telltale
