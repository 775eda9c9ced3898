#include "telltale/core/estimation/regression/sliding_regression.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/base/linear_algebra/covariance.hpp"
#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/base/range.hpp"
#include "telltale/core/estimation/regression/excitation.hpp"

namespace telltale {
namespace {

// Of the scaled Gram matrix: the square of the largest condition of Phi that counts as determined.
constexpr double kSmallestEigenvalue = 1e-10;

/// Pseudo-inverse of a Gram matrix; its rank is that of the matrix scaled to a unit diagonal.
struct PseudoInverse {
  Eigen::MatrixXd matrix;
  std::vector<bool> estimable;
  Eigen::Index rank = 0;
};

PseudoInverse Invert(const Eigen::MatrixXd& gram) {
  const Eigen::VectorXd norms = gram.diagonal().cwiseMax(0.0).cwiseSqrt();
  const Eigen::VectorXd scale = norms.unaryExpr([](double s) { return s > 0.0 ? 1.0 / s : 0.0; });
  const Eigen::MatrixXd scaled = Scaled(gram, scale);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scaled);
  const Eigen::VectorXd& values = solver.eigenvalues();  // ascending
  PseudoInverse inverse;
  const double smallest = kSmallestEigenvalue * values[values.size() - 1];
  inverse.rank = (values.array() > smallest).count();
  const Eigen::Index undetermined = values.size() - inverse.rank;
  const Eigen::MatrixXd root = scale.asDiagonal() * solver.eigenvectors().rightCols(inverse.rank) *
                               values.tail(inverse.rank).cwiseSqrt().cwiseInverse().asDiagonal();
  inverse.matrix = OfRoot(root);
  for (Eigen::Index j = 0; j < gram.rows(); ++j) {
    inverse.estimable.push_back(solver.eigenvectors().row(j).head(undetermined).squaredNorm() <
                                kUndeterminedShare);
  }
  return inverse;
}

double Bartlett(std::size_t lag, std::size_t lags) {
  return 1.0 - static_cast<double>(lag) / static_cast<double>(lags + 1);
}

}  // namespace

std::optional<Refusal> SlidingOptions::Validate() const {
  const std::string_view subject = "sliding window";
  if (auto refusal = OutOfRange(subject, "rows", static_cast<double>(rows), 10.0, 1e6)) {
    return refusal;
  }
  return OutOfRange(subject, "lags", static_cast<double>(lags), 0.0, 100.0);
}

SlidingRegression::SlidingRegression(std::size_t coefficients, const SlidingOptions& options)
    : options_(options),
      // Twice as many rows as are held: they stay contiguous, moved once a window.
      rows_(2 * options.rows, coefficients + 1),
      unbroken_(2 * options.rows) {
  Require(coefficients >= 1, "at least one coefficient");
  Require(!options.Validate(), "options within their ranges");
  grams_.assign(options.lags + 1, Eigen::MatrixXd::Zero(Width(), Width()));
}

void SlidingRegression::Push(std::span<const double> phi, double y, bool follows) {
  Require(static_cast<Eigen::Index>(phi.size()) == Width() - 1, "one number a coefficient");
  if (size() == options_.rows) Leave(begin_++);
  if (end_ == unbroken_.size()) StartAnew();
  auto row = rows_.row(static_cast<Eigen::Index>(end_));
  std::copy(phi.begin(), phi.end(), row.data());
  row[Width() - 1] = y;
  Require(row.allFinite(), "a finite row");
  unbroken_[end_] = follows && size() > 0 ? unbroken_[end_ - 1] + 1 : 0;
  Enter(end_++);
}

void SlidingRegression::Enter(std::size_t newest) {
  const std::size_t furthest = std::min({options_.lags, unbroken_[newest], newest - begin_});
  const auto now = rows_.row(static_cast<Eigen::Index>(newest));
  for (std::size_t lag = 0; lag <= furthest; ++lag) {
    const auto before = rows_.row(static_cast<Eigen::Index>(newest - lag));
    grams_[lag].noalias() += before.transpose() * now;
  }
}

void SlidingRegression::Leave(std::size_t oldest) {
  const auto leaving = rows_.row(static_cast<Eigen::Index>(oldest));
  for (std::size_t lag = 0; lag <= options_.lags && oldest + lag < end_; ++lag) {
    if (unbroken_[oldest + lag] < lag) return;
    const auto after = rows_.row(static_cast<Eigen::Index>(oldest + lag));
    grams_[lag].noalias() -= leaving.transpose() * after;
  }
}

/// Moves the rows held to the front and forms the Gram matrices from them alone.
void SlidingRegression::StartAnew() {
  const auto held = static_cast<Eigen::Index>(size());
  rows_.topRows(held) = rows_.middleRows(static_cast<Eigen::Index>(begin_), held).eval();
  std::copy(unbroken_.begin() + static_cast<std::ptrdiff_t>(begin_),
            unbroken_.begin() + static_cast<std::ptrdiff_t>(end_), unbroken_.begin());
  end_ = size();
  begin_ = 0;
  for (Eigen::MatrixXd& gram : grams_) gram.setZero();
  for (std::size_t row = 0; row < end_; ++row) Enter(row);
}

Eigen::VectorXd SlidingRegression::ResidualAutocovariances(const Eigen::VectorXd& theta) const {
  Eigen::VectorXd contrast(Width());
  contrast << -theta, 1.0;
  Eigen::VectorXd r(static_cast<Eigen::Index>(grams_.size()));
  for (std::size_t lag = 0; lag < grams_.size(); ++lag) {
    r[static_cast<Eigen::Index>(lag)] =
        contrast.dot(grams_[lag] * contrast) / static_cast<double>(size());
  }
  r[0] = std::max(r[0], 0.0);
  return r;
}

Result<SlidingEstimate> SlidingRegression::Estimate() const {
  const Eigen::Index p = Width() - 1;
  if (size() <= static_cast<std::size_t>(p)) {
    return Refuse("live bounds",
                  "only " + std::to_string(size()) + " rows are held for " + std::to_string(p) +
                      " coefficients",
                  "wait for more telemetry");
  }
  const PseudoInverse inverse = Invert(grams_[0].topLeftCorner(p, p));
  SlidingEstimate estimate;
  estimate.theta = inverse.matrix * grams_[0].col(p).head(p);
  estimate.estimable = inverse.estimable;
  estimate.rows = size();
  const auto n = static_cast<double>(size());
  const Eigen::VectorXd r = ResidualAutocovariances(estimate.theta);
  const double freed = n / (n - static_cast<double>(inverse.rank));
  estimate.residual_variance = freed * r[0];

  Eigen::MatrixXd scores = Eigen::MatrixXd::Zero(p, p);
  double sum = 0.0;
  for (std::size_t lag = 0; lag < grams_.size(); ++lag) {
    const double sides = lag == 0 ? 0.5 : 1.0;
    const double weighted =
        sides * Bartlett(lag, options_.lags) * r[static_cast<Eigen::Index>(lag)];
    const auto C = grams_[lag].topLeftCorner(p, p);
    scores += weighted * (C + C.transpose());
    sum += 2.0 * weighted;
  }
  const Eigen::MatrixXd covariance = freed * inverse.matrix * scores * inverse.matrix;
  estimate.standard_error = covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  for (Eigen::Index j = 0; j < p; ++j) {
    if (!inverse.estimable[static_cast<std::size_t>(j)]) {
      estimate.standard_error[j] = std::numeric_limits<double>::infinity();
    }
  }
  estimate.effective_rows = sum > 0.0 ? n * r[0] / sum : n;
  return estimate;
}

}  // namespace telltale
