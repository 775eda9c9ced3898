#include "telltale/core/estimation/regression/sliding_regression.hpp"

#include <cmath>
#include <deque>

#include <gtest/gtest.h>
#include <boost/random/normal_distribution.hpp>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/base/random.hpp"

namespace telltale {
namespace {

/// One row of a stream, kept to be fitted directly.
struct StreamRow {
  Eigen::VectorXd phi;
  double y = 0.0;
  bool follows = true;
};

std::span<const double> View(const Eigen::VectorXd& x) {
  return {x.data(), static_cast<std::size_t>(x.size())};
}

/// The definition, from the rows: residuals, their autocovariances and lagged Grams of Phi, pair by
/// pair.
SlidingEstimate Direct(const std::deque<StreamRow>& rows, std::size_t lags) {
  const auto n = static_cast<Eigen::Index>(rows.size());
  const Eigen::Index p = rows.front().phi.size();
  Eigen::MatrixXd phi(n, p);
  Eigen::VectorXd y(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    phi.row(i) = rows[static_cast<std::size_t>(i)].phi.transpose();
    y[i] = rows[static_cast<std::size_t>(i)].y;
  }
  SlidingEstimate direct;
  direct.theta = phi.colPivHouseholderQr().solve(y);
  const Eigen::VectorXd e = y - phi * direct.theta;
  const Eigen::MatrixXd gram = phi.transpose() * phi;
  const Eigen::MatrixXd inverse =
      gram.ldlt().solve(Eigen::MatrixXd(Eigen::MatrixXd::Identity(p, p)));
  Eigen::MatrixXd middle = Eigen::MatrixXd::Zero(p, p);
  double variance = 0.0;
  double sum = 0.0;
  for (std::size_t lag = 0; lag <= lags; ++lag) {
    double r = 0.0;
    Eigen::MatrixXd C = Eigen::MatrixXd::Zero(p, p);
    for (std::size_t t = lag; t < rows.size(); ++t) {
      bool unbroken = true;
      for (std::size_t s = t - lag + 1; s <= t; ++s) unbroken = unbroken && rows[s].follows;
      if (!unbroken) continue;
      const auto now = static_cast<Eigen::Index>(t);
      const auto before = static_cast<Eigen::Index>(t - lag);
      r += e[before] * e[now] / static_cast<double>(n);
      C += phi.row(before).transpose() * phi.row(now);
    }
    const double weight = 1.0 - static_cast<double>(lag) / static_cast<double>(lags + 1);
    middle += lag == 0 ? Eigen::MatrixXd(r * C) : Eigen::MatrixXd(weight * r * (C + C.transpose()));
    sum += (lag == 0 ? 1.0 : 2.0) * weight * r;
    if (lag == 0) variance = r;
  }
  const double freed = static_cast<double>(n) / static_cast<double>(n - p);
  direct.residual_variance = freed * variance;
  const Eigen::MatrixXd filling = middle * inverse;
  const Eigen::MatrixXd sandwich = inverse * filling;
  direct.standard_error = (freed * sandwich.diagonal()).cwiseSqrt();
  direct.effective_rows = static_cast<double>(n) * variance / sum;
  return direct;
}

void ExpectClose(const SlidingEstimate& sliding, const SlidingEstimate& direct, double relative) {
  EXPECT_LT((sliding.theta - direct.theta).norm(), relative * direct.theta.norm());
  EXPECT_TRUE(sliding.standard_error.isApprox(direct.standard_error, relative));
  EXPECT_NEAR(sliding.residual_variance, direct.residual_variance,
              relative * direct.residual_variance);
  EXPECT_NEAR(sliding.effective_rows, direct.effective_rows, relative * direct.effective_rows);
}

/// Regressors and residuals of first order, gaps now and then.
class Stream {
 public:
  Stream(Eigen::Index p, double rho_phi, double rho_e, std::uint64_t seed)
      : rho_phi_(rho_phi), rho_e_(rho_e), engine_(seed), phi_(Eigen::VectorXd::Zero(p)) {}

  StreamRow Next(bool follows = true) {
    for (double& value : phi_) value = rho_phi_ * value + Innovation(rho_phi_);
    e_ = rho_e_ * e_ + Innovation(rho_e_);
    return {phi_, phi_.sum() + e_, follows};
  }

 private:
  double Innovation(double rho) { return std::sqrt(1.0 - rho * rho) * normal_(engine_); }

  double rho_phi_;
  double rho_e_;
  RandomEngine engine_;
  boost::random::normal_distribution<double> normal_{0.0, 1.0};
  Eigen::VectorXd phi_;
  double e_ = 0.0;
};

TEST(SlidingRegression, IsTheDirectFitOfTheRowsHeldAtAnyMoment) {
  Stream stream(4, 0.8, 0.6, 1);
  SlidingRegression sliding(4, {50, 6});
  std::deque<StreamRow> held;
  for (std::size_t k = 0; k < 400; ++k) {
    held.push_back(stream.Next(k % 23 != 0));
    if (held.size() > 50) held.pop_front();
    sliding.Push(View(held.back().phi), held.back().y, held.back().follows);
    ASSERT_EQ(sliding.size(), held.size());
    if (k >= 10) ExpectClose(*sliding.Estimate(), Direct(held, 6), 1e-9);
  }
}

/// Days of telemetry: 10^7 rows of 13 regressors through a window. In each round of the tape a
/// burst of outliers passes and leaves its rounding behind when it goes: without matrices formed
/// anew from the rows held, theta ends up wrong by 5e-4. The instrumented builds take a hundredth.
TEST(SlidingRegression, HoldsOverTenMillionUpdates) {
#ifdef NDEBUG
  constexpr std::size_t kUpdates = 10'002'300;  // the burst has been gone for a while
#else
  constexpr std::size_t kUpdates = 102'300;
#endif
  constexpr Eigen::Index kColumns = 13;
  constexpr std::size_t kRows = 2000;
  constexpr std::size_t kLags = 2;
  std::vector<StreamRow> tape;  // of a prime length, so that windows keep changing
  Stream stream(kColumns, 0.8, 0.6, 5);
  for (std::size_t i = 0; i < 4999; ++i) tape.push_back(stream.Next(i % 487 != 0));
  for (std::size_t i = 100; i < 110; ++i) tape[i].phi *= 1e5;
  SlidingRegression sliding(kColumns, {kRows, kLags});
  for (std::size_t k = 0; k < kUpdates; ++k) {
    const StreamRow& row = tape[k % tape.size()];
    sliding.Push(View(row.phi), row.y, row.follows);
  }
  std::deque<StreamRow> held;
  for (std::size_t k = kUpdates - kRows; k < kUpdates; ++k) held.push_back(tape[k % tape.size()]);
  ExpectClose(*sliding.Estimate(), Direct(held, kLags), 1e-6);
}

/// AR(1) theory: for a regressor of memory a and residuals of memory rho, both of unit variance,
/// n Var(theta) = sum over k of w(k) (a rho)^|k|, and n / (rows white residuals stand for) = sum of
/// w(k) rho^|k|. 20 windows of 20,000 rows leave 1 %.
TEST(SlidingRegression, AgreesWithTheTheoryOfAutoregressions) {
  constexpr double kA = 0.9;
  constexpr double kRho = 0.8;
  constexpr std::size_t kRows = 20000;
  constexpr std::size_t kLags = 40;
  double variance = 0.0;
  double share = 0.0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Stream stream(1, kA, kRho, seed);
    SlidingRegression sliding(1, {kRows, kLags});
    for (std::size_t k = 0; k < kRows; ++k) {
      const StreamRow row = stream.Next();
      sliding.Push(View(row.phi), row.y, k > 0);
    }
    const auto estimate = sliding.Estimate();
    variance += std::pow(estimate->standard_error[0], 2) * kRows / 20.0;
    share += estimate->effective_rows / kRows / 20.0;
  }
  double theory = 1.0;
  double colour = 1.0;
  for (std::size_t k = 1; k <= kLags; ++k) {
    const double weight = 2.0 * (1.0 - static_cast<double>(k) / (kLags + 1.0));
    theory += weight * std::pow(kA * kRho, k);
    colour += weight * std::pow(kRho, k);
  }
  EXPECT_NEAR(variance / theory, 1.0, 0.04);
  EXPECT_NEAR(share * colour, 1.0, 0.04);
  // What the weights leave of the whole sum, (1 + a rho) / (1 - a rho), is known too.
  EXPECT_NEAR(theory / ((1.0 + kA * kRho) / (1.0 - kA * kRho)), 1.0, 0.08);
}

TEST(SlidingRegression, FollowsABoatThatChanges) {
  Stream stream(3, 0.5, 0.0, 9);
  SlidingRegression sliding(3, {500, 5});
  for (std::size_t k = 0; k < 1500; ++k) {
    const StreamRow row = stream.Next();
    sliding.Push(View(row.phi), k < 750 ? row.y : row.y + row.phi[1], true);
  }
  const auto estimate = sliding.Estimate();
  EXPECT_NEAR(estimate->theta[1], 2.0, 5.0 * estimate->standard_error[1]);
  EXPECT_NEAR(estimate->theta[0], 1.0, 5.0 * estimate->standard_error[0]);
}

TEST(SlidingRegression, NamesWhatTheRowsDoNotDetermine) {
  Stream stream(3, 0.5, 0.0, 9);
  SlidingRegression sliding(3, {500, 5});
  for (std::size_t k = 0; k < 800; ++k) {
    StreamRow row = stream.Next();
    row.y -= row.phi[2];
    row.phi[2] = 2.0 * row.phi[1];
    sliding.Push(View(row.phi), row.y, true);
  }
  const auto estimate = sliding.Estimate();
  EXPECT_EQ(estimate->estimable, (std::vector<bool>{true, false, false}));
  EXPECT_TRUE(std::isinf(estimate->standard_error[2]));
  EXPECT_NEAR(estimate->theta[0], 1.0, 5.0 * estimate->standard_error[0]);
}

TEST(SlidingRegression, RefusesTooFewRows) {
  SlidingRegression sliding(3, {500, 5});
  EXPECT_FALSE(sliding.Estimate());
  const Eigen::Vector3d phi(1.0, 2.0, 3.0);
  for (int k = 0; k < 3; ++k) sliding.Push(View(phi), 1.0, true);
  EXPECT_FALSE(sliding.Estimate());
}

TEST(SlidingRegression, HoldsItsContract) {
  EXPECT_THROW(SlidingRegression(3, {5, 5}), ContractViolation);
  EXPECT_THROW(SlidingRegression(0, {}), ContractViolation);
  SlidingRegression sliding(1, {});
  EXPECT_THROW(sliding.Push(View(Eigen::Vector2d::Ones()), 1.0, true), ContractViolation);
  EXPECT_THROW(sliding.Push(View(Eigen::VectorXd::Ones(1)), std::nan(""), true), ContractViolation);
  EXPECT_EQ(SlidingOptions({5, 5}).Validate()->subject, "sliding window");
}

}  // namespace
}  // namespace telltale
