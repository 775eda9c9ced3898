#include "telltale/core/diagnosis/baseline/residual_metric.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/base/gauss_markov_series.hpp"
#include "telltale/core/base/linear_algebra/covariance.hpp"
#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/base/linear_algebra/gram.hpp"
#include "telltale/core/diagnosis/diagnosis_constants.hpp"

namespace telltale {
namespace {

// In standard errors of the model: as good as free.
constexpr double kUnboundedPrior = kDiagnosis.metric.free_coefficient_sd;
// A window that errs by more root mean square sigmas than this counts as erring by so many: a model
// that has diverged says that it is wrong, not how much.
constexpr double kMaximumSigmas = kDiagnosis.metric.largest_sigmas;
constexpr double kNothing = 1e-12;
constexpr VariationConstants kVariation = kDiagnosis.variation;

/// One column for each direction that varies.
Eigen::MatrixXd RootOf(const Eigen::MatrixXd& covariance) {
  const Eigen::LDLT<Eigen::MatrixXd> factor(covariance);
  // Pivots fall: what does not vary stands last.
  const Eigen::Index rank = (factor.vectorD().array() > 0.0).count();
  const Eigen::MatrixXd root = Eigen::MatrixXd(factor.matrixL()).leftCols(rank) *
                               factor.vectorD().head(rank).cwiseSqrt().asDiagonal();
  return factor.transpositionsP().transpose() * root;
}

/// What of a Gauss-Markov process runs through a recording: independent courses of one standard
/// deviation, one a column, and the share of the variance that is faster.
struct SlowCourses {
  Eigen::MatrixXd by_window;
  double rest = 1.0;
};

SlowCourses SlowCoursesOf(const Eigen::ArrayXd& times_s, double time_constant_s) {
  const Eigen::ArrayXd since_s = times_s - times_s.minCoeff();
  // The series holds over any span that holds the recording.
  const double span_s = std::max(since_s.maxCoeff(), time_constant_s);
  const double lasting = time_constant_s / span_s;
  const int fastest = std::min(
      static_cast<int>(std::ceil(kVariation.fastest_radians / (std::numbers::pi * lasting))),
      kVariation.most_half_turns);
  SlowCourses slow;
  slow.by_window.resize(times_s.size(), 2 * fastest + 1);
  for (int k = 0; k <= fastest; ++k) {
    const double share = GaussMarkovShare(k, lasting);
    const Eigen::ArrayXd phases = since_s * (k * std::numbers::pi / span_s);
    slow.by_window.col(2 * k) = std::sqrt(share) * phases.cos();
    if (k > 0) slow.by_window.col(2 * k - 1) = std::sqrt(share) * phases.sin();
    slow.rest -= share;
  }
  return slow;
}

/// Each column of stacked errors times each course, window by window.
Eigen::MatrixXd ProductsByWindow(const Eigen::MatrixXd& stacked, const Eigen::MatrixXd& by_window) {
  const Eigen::Index rows = stacked.rows() / by_window.rows();
  Eigen::MatrixXd products(stacked.rows(), stacked.cols() * by_window.cols());
  for (Eigen::Index j = 0; j < stacked.cols(); ++j) {
    const auto windows = stacked.col(j).reshaped(rows, by_window.rows());
    for (Eigen::Index k = 0; k < by_window.cols(); ++k) {
      products.col(j * by_window.cols() + k) = (windows * by_window.col(k).asDiagonal()).reshaped();
    }
  }
  return products;
}

/// Columns whitened by one factor, as another one whitens them.
Eigen::MatrixXd Rewhitened(const Eigen::MatrixXd& white, const Eigen::LLT<Eigen::MatrixXd>& by,
                           const Eigen::LLT<Eigen::MatrixXd>& anew) {
  const Eigen::MatrixXd change = anew.matrixL().solve(Eigen::MatrixXd(by.matrixL()));
  const Eigen::MatrixXd windows =
      change.triangularView<Eigen::Lower>() * white.reshaped(by.rows(), white.size() / by.rows());
  return windows.reshaped(white.rows(), white.cols());
}

}  // namespace

ResidualMetric::ResidualMetric(const NominalBaseline& nominal, const Sensitivity& recording,
                               std::vector<std::size_t> windows, bool free_coefficients)
    : windows_(std::move(windows)),
      times_s_(Eigen::Map<const Eigen::ArrayXd>(recording.window_times_s.data(),
                                                std::ssize(recording.window_times_s))),
      frees_coefficients_(free_coefficients),
      covariance_(nominal.covariance),
      factor_(covariance_),
      kappa_(nominal.kappa) {
  const Eigen::Index base = recording.by_coefficient.cols();
  const Eigen::Index parameter_count = recording.by_effect_parameter.cols();
  Eigen::MatrixXd covariance = nominal.boat_covariance;
  if (free_coefficients)
    covariance.diagonal().head(base).array() += kUnboundedPrior * kUnboundedPrior;
  const Eigen::MatrixXd root = RootOf(covariance);
  coefficient_root_ = root.topRows(base);
  Eigen::MatrixXd boat(recording.errors.size(), base + parameter_count);
  boat << recording.by_coefficient, recording.by_effect_parameter;
  std::vector<Eigen::Index> random_effects;
  for (Eigen::Index j = 0; j < parameter_count; ++j) {
    if (nominal.recording_effect_sd[j] > 0.0) random_effects.push_back(j);
  }
  Eigen::MatrixXd nuisance(recording.errors.size(), root.cols() + std::ssize(random_effects));
  // A day's weather is one draw of its own and counts in full, where errors count by effective
  // observations.
  nuisance << boat * root,
      recording.by_effect_parameter(Eigen::all, random_effects) *
          (nominal.recording_effect_sd(random_effects) / std::sqrt(RowsPerObservation()))
              .asDiagonal();
  nuisance_ = WhitenColumns(nuisance);
  FactoriseNuisance();
}

void ResidualMetric::FactoriseNuisance() {
  Eigen::MatrixXd weights = Gram(nuisance_);
  weights.diagonal().array() += 1.0;
  nuisance_factor_.compute(weights);
}

ResidualMetric ResidualMetric::WithWindowVariation(const Eigen::MatrixXd& varying) const {
  const Eigen::Index rows = factor_.rows();
  const Eigen::Index columns = varying.cols();
  const Eigen::MatrixXd white = WhitenColumns(varying) / std::sqrt(kappa_);
  ResidualMetric metric = *this;
  metric.window_variation_.resize(rows, columns * std::ssize(windows_));
  for (Eigen::Index w = 0; w < std::ssize(windows_); ++w) {
    const auto window = white.middleRows(w * rows, rows);
    const Eigen::MatrixXd gram = window.transpose() * window;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(gram);
    const Eigen::ArrayXd squares = axes.eigenvalues().array().max(kNothing);
    const Eigen::VectorXd damped = ((1.0 - (1.0 + squares).rsqrt()) / squares).sqrt();
    metric.window_variation_.middleCols(w * columns, columns) =
        window * axes.eigenvectors() * damped.asDiagonal();
    metric.variation_penalty_ += kappa_ * squares.log1p().sum() / RowsPerObservation();
  }
  metric.DeflateWindowVariation(metric.nuisance_);
  metric.FactoriseNuisance();
  return metric;
}

ResidualMetric ResidualMetric::WithVariation(const ErrorVariation& variation) const {
  const Eigen::MatrixXd& drifting = variation.drifting;
  if (drifting.size() == 0) return WithWindowVariation(variation.by_window);
  Require(drifting.rows() == factor_.rows() * times_s_.size(), "the time of every window");
  const SlowCourses slow = SlowCoursesOf(times_s_, variation.drift_time_s);
  Eigen::MatrixXd by_window(drifting.rows(), variation.by_window.cols() + drifting.cols());
  by_window << variation.by_window, std::sqrt(slow.rest) * drifting;
  ResidualMetric metric = WithWindowVariation(by_window);
  const double without = LogDeterminant(metric.nuisance_factor_);
  const Eigen::Index added = drifting.cols() * slow.by_window.cols();
  metric.nuisance_.conservativeResize(Eigen::NoChange, nuisance_.cols() + added);
  // A drift is one draw for all windows and counts in full, as a day's weather does.
  metric.nuisance_.rightCols(added) =
      metric.WhitenColumns(ProductsByWindow(drifting, slow.by_window)) /
      std::sqrt(RowsPerObservation());
  metric.FactoriseNuisance();
  metric.variation_penalty_ += LogDeterminant(metric.nuisance_factor_) - without;
  return metric;
}

ResidualMetric ResidualMetric::WithWindowScatter(const Eigen::MatrixXd& covariance) const {
  ResidualMetric metric = *this;
  metric.covariance_ += covariance;
  metric.factor_.compute(metric.covariance_);
  metric.nuisance_ = Rewhitened(nuisance_, factor_, metric.factor_);
  metric.FactoriseNuisance();
  const auto windows = static_cast<double>(windows_.size());
  metric.variation_penalty_ += kappa_ * windows *
                               (LogDeterminant(metric.factor_) - LogDeterminant(factor_)) /
                               RowsPerObservation();
  return metric;
}

ResidualMetric ResidualMetric::WithFree(const Eigen::MatrixXd& columns) const {
  ResidualMetric metric = *this;
  metric.nuisance_.conservativeResize(Eigen::NoChange, nuisance_.cols() + columns.cols());
  metric.nuisance_.rightCols(columns.cols()) =
      WhitenColumns(columns) / std::sqrt(RowsPerObservation());
  metric.FactoriseNuisance();
  return metric;
}

void ResidualMetric::DeflateWindowVariation(Eigen::MatrixXd& whitened) const {
  if (window_variation_.size() == 0) return;
  const Eigen::Index rows = factor_.rows();
  const Eigen::Index columns = window_variation_.cols() / std::ssize(windows_);
  for (Eigen::Index w = 0; w < std::ssize(windows_); ++w) {
    const auto allowed = window_variation_.middleCols(w * columns, columns);
    auto window = whitened.middleRows(w * rows, rows);
    window -= allowed * (allowed.transpose() * window).eval();
  }
}

Eigen::VectorXd ResidualMetric::Whiten(const Eigen::MatrixXd& errors) const {
  Eigen::VectorXd whitened = WhitenColumns(errors.reshaped()).col(0);
  auto windows = whitened.reshaped(factor_.rows(), whitened.size() / factor_.rows());
  const double most = kMaximumSigmas * std::sqrt(static_cast<double>(factor_.rows()));
  for (auto window : windows.colwise()) window *= std::min(1.0, most / window.norm());
  return whitened;
}

double ResidualMetric::ExpectedSquare() const {
  return kappa_ * static_cast<double>(windows_.size()) * static_cast<double>(factor_.rows());
}

double ResidualMetric::EffectiveObservations() const {
  return kDiagnosis.metric.observations_per_window * kappa_ * static_cast<double>(windows_.size());
}

double ResidualMetric::ParameterPenalty() const {
  return std::log(std::max(EffectiveObservations(), 2.0));
}

double ResidualMetric::Deviance(double square, double than) const {
  return EffectiveObservations() * std::log(square / than);
}

double ResidualMetric::Sigmas(const Eigen::VectorXd& whitened) const {
  return std::sqrt(SquaredMahalanobis(whitened) / RowsPerObservation());
}

Eigen::MatrixXd ResidualMetric::WhitenColumns(const Eigen::MatrixXd& stacked) const {
  const Eigen::Index rows = factor_.rows();
  Eigen::MatrixXd chosen(rows * static_cast<Eigen::Index>(windows_.size()), stacked.cols());
  for (Eigen::Index j = 0; j < stacked.cols(); ++j) {
    const auto all = stacked.col(j).reshaped(rows, stacked.rows() / rows);
    chosen.col(j) = all(Eigen::all, windows_).reshaped();
  }
  Eigen::MatrixXd whitened = std::sqrt(kappa_) * Whitened(factor_, chosen);
  DeflateWindowVariation(whitened);
  return whitened;
}

Eigen::MatrixXd ResidualMetric::WhitenMoment(const Eigen::MatrixXd& pattern) const {
  const Eigen::MatrixXd half = factor_.matrixL().solve(pattern);
  return factor_.matrixL().solve(half.transpose());
}

Eigen::MatrixXd ResidualMetric::Marginalise(const Eigen::MatrixXd& whitened) const {
  const Eigen::MatrixXd along = nuisance_.transpose() * whitened;
  const Eigen::MatrixXd taken = nuisance_factor_.solve(along);
  return whitened - nuisance_ * taken;
}

Eigen::MatrixXd ResidualMetric::UnexplainedByWindow(const Eigen::VectorXd& whitened) const {
  const Eigen::VectorXd left = Unexplained(whitened) / std::sqrt(kappa_);
  return left.reshaped(factor_.rows(), static_cast<Eigen::Index>(windows_.size()));
}

ResidualMetric::Recalibration ResidualMetric::Recalibrate(const Eigen::VectorXd& whitened) const {
  const Eigen::Index boat = coefficient_root_.cols();
  const Eigen::VectorXd along = nuisance_.transpose() * whitened;
  const Eigen::VectorXd nuisance = nuisance_factor_.solve(along);
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(nuisance_.cols(), nuisance_.cols());
  const Eigen::MatrixXd covariance = nuisance_factor_.solve(identity).topLeftCorner(boat, boat);
  return {-coefficient_root_ * nuisance.head(boat), Mapped(coefficient_root_, covariance)};
}

double LogDeterminant(const Eigen::LLT<Eigen::MatrixXd>& factor) {
  return 2.0 * factor.matrixLLT().diagonal().array().log().sum();
}

Eigen::MatrixXd Whitened(const Eigen::LLT<Eigen::MatrixXd>& factor,
                         const Eigen::MatrixXd& stacked) {
  const Eigen::Index rows = factor.rows();
  Eigen::MatrixXd white = stacked;
  auto windows = white.reshaped(rows, white.size() / rows);
  factor.matrixL().solveInPlace(windows);
  return white;
}

std::vector<std::size_t> EveryWindow(const Sensitivity& recording) {
  std::vector<std::size_t> windows(static_cast<std::size_t>(recording.errors.cols()));
  std::iota(windows.begin(), windows.end(), std::size_t{0});
  return windows;
}

}  // namespace telltale
