#include "telltale/core/diagnosis/hypotheses/levenberg_marquardt.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/diagnosis/diagnosis_constants.hpp"

namespace telltale {
namespace {

constexpr double kInitialDamping = 1e-3;
constexpr double kMinimumDamping = 1e-6;
constexpr double kMaximumDamping = 1e4;

// Of the gain at which a step is the last: a step that promises less is not taken.
constexpr double kNothing = 1e-3;

/// Half the gradient and half the curvature of the cost about a point.
struct QuadraticModel {
  Eigen::MatrixXd information;
  Eigen::VectorXd gradient;

  double GainOf(const Eigen::VectorXd& step) const {
    return -2.0 * gradient.dot(step) - step.dot(information * step);
  }
};

Minimum WithDerivatives(const EffectPosterior& posterior, const PosteriorPoint& point) {
  Minimum at{point, posterior.Jacobian(point), {}};
  at.marginalised = posterior.Metric().Marginalise(at.jacobian);
  return at;
}

QuadraticModel ModelAbout(const EffectPosterior& posterior, const Minimum& at) {
  return {posterior.Information(at.point, at.jacobian, at.marginalised),
          posterior.Gradient(at.point, at.marginalised)};
}

/// Where a damped step within the bounds leads to.
Eigen::VectorXd DampedStep(const EffectPosterior& posterior, const Eigen::VectorXd& from,
                           const QuadraticModel& model, double damping) {
  Eigen::MatrixXd damped = model.information;
  damped.diagonal() *= 1.0 + damping;
  return posterior.Parameters().Clamped(from - damped.ldlt().solve(model.gradient));
}

/// A point of lower cost, by the least damping from `damping` on that leads to one. A step that
/// promises nothing, at a bound mostly, is not tried.
std::optional<PosteriorPoint> LowerPoint(const EffectPosterior& posterior,
                                         const PosteriorPoint& from, const QuadraticModel& model,
                                         double& damping) {
  for (; damping < kMaximumDamping; damping *= 10.0) {
    const Eigen::VectorXd to = DampedStep(posterior, from.scaled, model, damping);
    constexpr double kLeast = kNothing * kDiagnosis.effect_fit.converged_gain;
    if (!(model.GainOf(to - from.scaled) > kLeast)) continue;
    PosteriorPoint next = posterior.At(to);
    if (next.cost < from.cost) return next;
  }
  return std::nullopt;
}

}  // namespace

Minimum MinimiseCost(const EffectPosterior& posterior, const PosteriorPoint& point) {
  Minimum best = WithDerivatives(posterior, point);
  double damping = kInitialDamping;
  for (int iteration = 0; iteration < kDiagnosis.effect_fit.maximum_iterations; ++iteration) {
    auto next = LowerPoint(posterior, best.point, ModelAbout(posterior, best), damping);
    if (!next) return best;
    damping = std::max(damping / 10.0, kMinimumDamping);
    const double gained = best.point.cost - next->cost;
    if (gained < kDiagnosis.effect_fit.converged_gain) {
      best.point = *std::move(next);
      return best;
    }
    best = WithDerivatives(posterior, *next);
  }
  return best;
}

}  // namespace telltale
