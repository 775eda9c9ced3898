#include "telltale/core/diagnosis/judge.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "telltale/core/linear_algebra/covariance.hpp"
#include "telltale/core/linear_algebra/decompositions.hpp"

namespace telltale {
namespace {

// In standard errors of the model: as good as free.
constexpr double kFree = 100.0;
// A window that errs by more root mean square sigmas than this counts as erring by so many: a model
// that has run away says that it is wrong, not how much.
constexpr double kMostSigmas = 50.0;
constexpr double kNothing = 1e-12;

Eigen::MatrixXd RootOf(const Eigen::MatrixXd& covariance) {
  const Eigen::LDLT<Eigen::MatrixXd> factor(covariance);
  const Eigen::MatrixXd root =
      Eigen::MatrixXd(factor.matrixL()) * factor.vectorD().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  return factor.transpositionsP().transpose() * root;
}

}  // namespace

Judge::Judge(const Healthy& healthy, const Sensitivity& recording, std::vector<std::size_t> windows,
             bool free_base)
    : windows_(std::move(windows)),
      frees_base_(free_base),
      factor_(healthy.covariance),
      kappa_(healthy.kappa) {
  const Eigen::Index base = recording.by_base.cols();
  const Eigen::Index slots = recording.by_slot.cols();
  Eigen::MatrixXd covariance = healthy.boat_covariance;
  if (free_base) covariance.diagonal().head(base).array() += kFree * kFree;
  const Eigen::MatrixXd root = RootOf(covariance);
  base_root_ = root.topRows(base);
  Eigen::MatrixXd boat(recording.errors.size(), base + slots);
  boat << recording.by_base, recording.by_slot;
  std::vector<Eigen::Index> weather;
  for (Eigen::Index j = 0; j < slots; ++j) {
    if (healthy.day_sizes[j] > 0.0) weather.push_back(j);
  }
  Eigen::MatrixXd loose(recording.errors.size(), base + slots + std::ssize(weather));
  // A day's weather is one draw of its own and counts in full, where errors count by looks.
  loose << boat * root, recording.by_slot(Eigen::all, weather) *
                            (healthy.day_sizes(weather) / std::sqrt(RowsALook())).asDiagonal();
  loose_ = SeeColumns(loose);
  WeighLoose();
}

void Judge::WeighLoose() {
  Eigen::MatrixXd weights = loose_.transpose() * loose_;
  weights.diagonal().array() += 1.0;
  weigher_.compute(weights);
}

Judge Judge::Allowing(const Eigen::MatrixXd& varying) const {
  const Eigen::Index rows = factor_.rows();
  const Eigen::Index many = varying.cols();
  const Eigen::MatrixXd white = SeeColumns(varying) / std::sqrt(kappa_);
  Judge judge = *this;
  judge.allowed_.resize(rows, many * std::ssize(windows_));
  for (Eigen::Index w = 0; w < std::ssize(windows_); ++w) {
    const auto window = white.middleRows(w * rows, rows);
    const Eigen::MatrixXd gram = window.transpose() * window;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(gram);
    const Eigen::ArrayXd squares = axes.eigenvalues().array().max(kNothing);
    const Eigen::VectorXd damped = ((1.0 - (1.0 + squares).rsqrt()) / squares).sqrt();
    judge.allowed_.middleCols(w * many, many) = window * axes.eigenvectors() * damped.asDiagonal();
    judge.allowance_ += kappa_ * squares.log1p().sum() / RowsALook();
  }
  judge.DampAllowed(judge.loose_);
  judge.WeighLoose();
  return judge;
}

void Judge::DampAllowed(Eigen::MatrixXd& seen) const {
  if (allowed_.size() == 0) return;
  const Eigen::Index rows = factor_.rows();
  const Eigen::Index many = allowed_.cols() / std::ssize(windows_);
  for (Eigen::Index w = 0; w < std::ssize(windows_); ++w) {
    const auto allowed = allowed_.middleCols(w * many, many);
    auto window = seen.middleRows(w * rows, rows);
    window -= allowed * (allowed.transpose() * window).eval();
  }
}

Eigen::VectorXd Judge::See(const Eigen::MatrixXd& errors) const {
  Eigen::VectorXd seen = SeeColumns(errors.reshaped()).col(0);
  auto windows = seen.reshaped(factor_.rows(), seen.size() / factor_.rows());
  const double most = kMostSigmas * std::sqrt(static_cast<double>(factor_.rows()));
  for (auto window : windows.colwise()) window *= std::min(1.0, most / window.norm());
  return seen;
}

double Judge::Expected() const {
  return kappa_ * static_cast<double>(windows_.size()) * static_cast<double>(factor_.rows());
}

double Judge::Looks() const {
  return kLooksAWindow * kappa_ * static_cast<double>(windows_.size());
}

double Judge::Evidence(double square, double than) const {
  return Looks() * std::log(square / than);
}

double Judge::Sigmas(const Eigen::VectorXd& seen) const {
  return std::sqrt(Square(seen) / RowsALook());
}

Eigen::MatrixXd Judge::SeeColumns(const Eigen::MatrixXd& stacked) const {
  const Eigen::Index rows = factor_.rows();
  Eigen::MatrixXd chosen(rows * static_cast<Eigen::Index>(windows_.size()), stacked.cols());
  for (Eigen::Index j = 0; j < stacked.cols(); ++j) {
    const auto all = stacked.col(j).reshaped(rows, stacked.rows() / rows);
    chosen.col(j) = all(Eigen::all, windows_).reshaped();
  }
  Eigen::MatrixXd seen = std::sqrt(kappa_) * Whitened(factor_, chosen);
  DampAllowed(seen);
  return seen;
}

Eigen::MatrixXd Judge::Whiten(const Eigen::MatrixXd& pattern) const {
  const Eigen::MatrixXd half = factor_.matrixL().solve(pattern);
  return factor_.matrixL().solve(half.transpose());
}

Eigen::MatrixXd Judge::Weigh(const Eigen::MatrixXd& seen) const {
  const Eigen::MatrixXd along = loose_.transpose() * seen;
  const Eigen::MatrixXd taken = weigher_.solve(along);
  return seen - loose_ * taken;
}

Eigen::MatrixXd Judge::UnexplainedByWindow(const Eigen::VectorXd& seen) const {
  const Eigen::VectorXd left = Unexplained(seen) / std::sqrt(kappa_);
  return left.reshaped(factor_.rows(), static_cast<Eigen::Index>(windows_.size()));
}

Judge::Recalibration Judge::Recalibrate(const Eigen::VectorXd& seen) const {
  const Eigen::Index boat = base_root_.cols();
  const Eigen::VectorXd along = loose_.transpose() * seen;
  const Eigen::VectorXd loose = weigher_.solve(along);
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(loose_.cols(), loose_.cols());
  const Eigen::MatrixXd covariance = weigher_.solve(identity).topLeftCorner(boat, boat);
  return {-base_root_ * loose.head(boat), Mapped(base_root_, covariance)};
}

Eigen::MatrixXd Whitened(const Eigen::LLT<Eigen::MatrixXd>& factor,
                         const Eigen::MatrixXd& stacked) {
  const Eigen::Index rows = factor.rows();
  Eigen::MatrixXd white = stacked;
  for (Eigen::Index j = 0; j < white.cols(); ++j) {
    auto windows = white.col(j).reshaped(rows, stacked.rows() / rows);
    factor.matrixL().solveInPlace(windows);
  }
  return white;
}

std::vector<std::size_t> EveryWindow(const Sensitivity& recording) {
  std::vector<std::size_t> windows(static_cast<std::size_t>(recording.errors.cols()));
  std::iota(windows.begin(), windows.end(), std::size_t{0});
  return windows;
}

}  // namespace telltale
