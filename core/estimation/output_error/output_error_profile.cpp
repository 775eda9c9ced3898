#include "telltale/core/estimation/output_error/output_error_profile.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/estimation/output_error/output_error_covariance.hpp"
#include "telltale/core/vessel/thruster_response.hpp"

namespace telltale {
namespace {

constexpr std::size_t kSampled = 64;  // shooting segments from which asymmetry is estimated
constexpr double kTolerance = 1e-8;   // of the sum: hundredths of a threshold
constexpr int kIterations = 25;
constexpr double kPriorWeakening = 0.03;  // so that the ridge prior does not narrow the profile
constexpr double kBeyondAll = 1e9;        // greater than any threshold

}  // namespace

OutputErrorProfile::OutputErrorProfile(const PreparedDataset& dataset,
                                       const RegressionOptions& regression,
                                       const OutputErrorFit& fit, const OutputErrorOptions& options)
    : fit_(fit),
      plan_(CutShootingSegments(dataset, regression, fit.unknowns, options.shooting_segments)),
      ridge_prior_(MakeRidgePrior(dataset, fit.unknowns, fit.begin)),
      noise_scale_{fit.position_misfit, fit.heading_misfit, options.huber_threshold},
      optimum_(plan_, fit.unknowns, ridge_prior_, options.huber_threshold, fit.theta),
      naive_(NaiveCovariance(fit)) {
  Require(fit.starts.size() == plan_.shooting_segments.size(), "the shooting segments of the fit");
  ridge_prior_.weight *= kPriorWeakening;
  optimum_.MoveTo(fit.theta, fit.starts);
  optimum_.Descend(noise_scale_, kTolerance, kIterations);
  optimum_sum_ = optimum_.Sum(noise_scale_);
  const std::size_t stride = std::max<std::size_t>(1, plan_.shooting_segments.size() / kSampled);
  for (std::size_t shooting_segment = 0; shooting_segment < plan_.shooting_segments.size();
       shooting_segment += stride) {
    const auto shooting_residual = optimum_.ComputeResidual(shooting_segment, noise_scale_, true);
    Require(shooting_residual.has_value(), "a fit that does not diverge");
    Linearised linear{
        shooting_segment, shooting_residual->residual, shooting_residual->by_shared, {}};
    linear.start_by_theta = -Eigen::HouseholderQR<Eigen::MatrixXd>(shooting_residual->by_start)
                                 .solve(Eigen::MatrixXd(shooting_residual->by_shared));
    linear.by_theta += shooting_residual->by_start * linear.start_by_theta;
    sample_.push_back(std::move(linear));
  }
}

Eigen::VectorXd OutputErrorProfile::StepOf(Eigen::Index unknown, double step) const {
  return step / naive_(unknown, unknown) * naive_.col(unknown);
}

double OutputErrorProfile::Asymmetry(Eigen::Index unknown, double half_width) const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const Eigen::VectorXd step = StepOf(unknown, half_width);
  double square = 0.0;
  double cube = 0.0;
  for (const Linearised& at : sample_) {
    const ShootingSegment& shooting_segment = plan_.shooting_segments[at.shooting_segment];
    const ShootingState start = at.start_by_theta * step;
    const Eigen::VectorXd linear = at.by_theta * step;
    const auto squared = [&](double direction) {
      const auto shooting_residual = ComputeShootingResidual(
          plan_, shooting_segment, fit_.unknowns, optimum_.Theta() + direction * step,
          optimum_.Starts()[at.shooting_segment] + direction * start, noise_scale_, false);
      return shooting_residual ? shooting_residual->residual.squaredNorm() : kInfinity;
    };
    square += linear.squaredNorm();
    cube += 0.5 * (squared(1.0) - squared(-1.0)) - 2.0 * at.residual.dot(linear);
  }
  const double share = std::abs(cube) / square;
  return share < 1.0 ? std::sqrt((1.0 + share) / (1.0 - share)) : kInfinity;
}

double OutputErrorProfile::Deviance(Eigen::Index unknown, double value) const {
  ShootingSolution solution = optimum_;
  Eigen::VectorXd theta = optimum_.Theta() + StepOf(unknown, value - optimum_.Theta()[unknown]);
  theta[unknown] = value;
  if (fit_.unknowns.lagging)
    theta[0] = std::clamp(theta[0], kShortestTimeConstantS, kLongestTimeConstantS);
  solution.MoveTo(theta, optimum_.Starts());
  if (solution.Diverges()) {
    theta = optimum_.Theta();
    theta[unknown] = value;
    solution.MoveTo(theta, optimum_.Starts());
    if (solution.Diverges()) return kBeyondAll;
  }
  solution.Descend(noise_scale_, kTolerance, kIterations, unknown);
  const double rise = (solution.Sum(noise_scale_) - optimum_sum_) / fit_.residual_variance;
  return std::isfinite(rise) ? std::max(rise, 0.0) : kBeyondAll;
}

}  // namespace telltale
