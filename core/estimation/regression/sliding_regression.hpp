#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/base/result.hpp"

namespace telltale {

struct SlidingOptions {
  std::size_t rows = 6000;  ///< the newest rows held, [10, 1e6]
  std::size_t lags = 12;    ///< rows over which residuals are autocorrelated, [0, 100]

  /// The first field out of its range, as a refusal naming field, value and range.
  std::optional<Refusal> Validate() const;
};

/// Shapes: theta, standard_error, estimable p. A coefficient that is a part of a direction the rows
/// held do not determine is not estimable: the minimum-norm choice, with infinite standard error.
struct SlidingEstimate {
  Eigen::VectorXd theta;
  Eigen::VectorXd standard_error;
  std::vector<bool> estimable;
  double residual_variance = 0.0;  ///< of y, by the degrees of freedom left
  std::size_t rows = 0;            ///< held
  double effective_rows = 0.0;     ///< white residuals that determine their mean as well
};

/// Least squares over the newest rows of a stream.
/// Model: y(k) = phi(k)'theta + e(k), e of autocovariances r(k) independent of phi. State: lagged
/// Gram matrices Z(k) = sum z(t - k) z(t)' of z = [phi; y], k = 0..lags, over pairs of rows held
/// with no gap between; a row entering or leaving costs O(lags p^2). From them, at any moment and
/// exactly for the theta of that moment,
///   r(k) = (1/n) [-theta; 1]'Z(k)[-theta; 1],
///   Cov(theta) = A^-1 [sum_|k|<=lags w(k) r(k) (C(k) + C(k)')/2] A^-1, w(k) = 1 - |k| / (lags + 1)
/// with A = C(0) and C(k) the phi-phi part of Z(k); a covariance for every r that data can show.
/// Rounding: rows leave by subtraction, so after as many rows as the window holds the matrices are
/// formed anew from the rows held; what one pass can gather never grows.
/// Normal equations square the condition of Phi: directions beyond a condition of 1e5 (columns
/// scaled to unit norm) count as undetermined.
/// Source: Morelli, Klein, "Accuracy of aerodynamic model parameters estimated from flight test
/// data", Journal of Guidance, Control, and Dynamics 20 (1997), coloured residuals; Newey, West,
/// Econometrica 55 (1987), weights.
class SlidingRegression {
 public:
  /// Requires: at least one coefficient, options within their ranges.
  SlidingRegression(std::size_t coefficients, const SlidingOptions& options);

  /// Takes in the next row, and drops the oldest of a full window. `follows`: it comes one sampling
  /// period after the row before. Requires: phi of one number a coefficient, everything finite.
  void Push(std::span<const double> phi, double y, bool follows);

  std::size_t size() const { return end_ - begin_; }

  /// Refuses when: no more rows than coefficients are held.
  Result<SlidingEstimate> Estimate() const;

 private:
  Eigen::Index Width() const { return rows_.cols(); }
  void Enter(std::size_t newest);
  void Leave(std::size_t oldest);
  void StartAnew();
  Eigen::VectorXd ResidualAutocovariances(const Eigen::VectorXd& theta) const;

  SlidingOptions options_;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows_;  // [phi y]
  std::vector<std::size_t> unbroken_;  // rows right before this one without a gap, of each row
  std::size_t begin_ = 0;              // rows held are [begin_, end_) of rows_
  std::size_t end_ = 0;
  std::vector<Eigen::MatrixXd> grams_;  // Z(0) .. Z(lags)
};

}  // namespace telltale
