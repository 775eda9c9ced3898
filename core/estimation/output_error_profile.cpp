#include "telltale/core/estimation/output_error_profile.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "telltale/core/contract.hpp"
#include "telltale/core/estimation/weak_iv.hpp"
#include "telltale/core/linear_algebra/decompositions.hpp"

namespace telltale {
namespace {

constexpr std::size_t kSampled = 64;  // shots that tell how lopsided a profile is
constexpr double kTolerance = 1e-8;   // of the sum: hundredths of what a threshold is
constexpr int kIterations = 25;
constexpr double kLighter = 0.03;   // a leash that tells nothing of what the data tell little of
constexpr double kBeyondAll = 1e9;  // any threshold

}  // namespace

OutputErrorProfile::OutputErrorProfile(const PreparedDataset& dataset,
                                       const RegressionOptions& regression,
                                       const OutputErrorFit& fit, const OutputErrorOptions& options)
    : fit_(fit),
      plan_(CutShots(dataset, regression, fit.unknowns, options.shots)),
      leash_(LeashOn(dataset, fit.unknowns, fit.begin)),
      yardstick_{fit.position_misfit, fit.heading_misfit, options.knee},
      least_(plan_, fit.unknowns, leash_, options.knee, fit.theta),
      naive_(NaiveCovariance(fit)) {
  Require(fit.starts.size() == plan_.shots.size(), "the shots of the fit");
  leash_.weight *= kLighter;
  least_.MoveTo(fit.theta, fit.starts);
  least_.Descend(yardstick_, kTolerance, kIterations);
  least_sum_ = least_.Sum(yardstick_);
  const std::size_t stride = std::max<std::size_t>(1, plan_.shots.size() / kSampled);
  for (std::size_t shot = 0; shot < plan_.shots.size(); shot += stride) {
    const auto miss = least_.Sight(shot, yardstick_, true);
    Require(miss.has_value(), "a fit that does not run away");
    Linear linear{shot, miss->residual, miss->by_shared, {}};
    linear.start_by_theta = -Eigen::HouseholderQR<Eigen::MatrixXd>(miss->by_start)
                                 .solve(Eigen::MatrixXd(miss->by_shared));
    linear.by_theta += miss->by_start * linear.start_by_theta;
    sample_.push_back(std::move(linear));
  }
}

Eigen::VectorXd OutputErrorProfile::Follow(Eigen::Index unknown, double step) const {
  return step / naive_(unknown, unknown) * naive_.col(unknown);
}

double OutputErrorProfile::Lopsidedness(Eigen::Index unknown, double reach) const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const Eigen::VectorXd step = Follow(unknown, reach);
  double square = 0.0;
  double cube = 0.0;
  for (const Linear& at : sample_) {
    const Shot& shot = plan_.shots[at.shot];
    const ShotState start = at.start_by_theta * step;
    const Eigen::VectorXd linear = at.by_theta * step;
    const auto squared = [&](double direction) {
      const auto miss = Shoot(plan_, shot, fit_.unknowns, least_.Theta() + direction * step,
                              least_.Starts()[at.shot] + direction * start, yardstick_, false);
      return miss ? miss->residual.squaredNorm() : kInfinity;
    };
    square += linear.squaredNorm();
    cube += 0.5 * (squared(1.0) - squared(-1.0)) - 2.0 * at.residual.dot(linear);
  }
  const double share = std::abs(cube) / square;
  return share < 1.0 ? std::sqrt((1.0 + share) / (1.0 - share)) : kInfinity;
}

double OutputErrorProfile::Deviance(Eigen::Index unknown, double value) const {
  ShotSolution solution = least_;
  Eigen::VectorXd theta = least_.Theta() + Follow(unknown, value - least_.Theta()[unknown]);
  theta[unknown] = value;
  if (fit_.unknowns.lagging) theta[0] = std::clamp(theta[0], kLeastTimeConstantS, kLongestLagS);
  solution.MoveTo(theta, least_.Starts());
  if (solution.RunsAway()) {
    theta = least_.Theta();
    theta[unknown] = value;
    solution.MoveTo(theta, least_.Starts());
    if (solution.RunsAway()) return kBeyondAll;
  }
  solution.Descend(yardstick_, kTolerance, kIterations, unknown);
  const double rise = (solution.Sum(yardstick_) - least_sum_) / fit_.residual_variance;
  return std::isfinite(rise) ? std::max(rise, 0.0) : kBeyondAll;
}

}  // namespace telltale
