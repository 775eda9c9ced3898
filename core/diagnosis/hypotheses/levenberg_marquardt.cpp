#include "telltale/core/diagnosis/hypotheses/levenberg_marquardt.hpp"

#include <algorithm>

#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/diagnosis/diagnosis_constants.hpp"

namespace telltale {
namespace {

constexpr double kInitialDamping = 1e-3;
constexpr double kMinimumDamping = 1e-6;
constexpr double kMaximumDamping = 1e4;

/// The quadratic model of the cost about a point: half its gradient and half its curvature.
struct NormalEquations {
  Eigen::MatrixXd information;
  Eigen::VectorXd gradient;
};

NormalEquations NormalEquationsAt(const EffectPosterior& posterior, const PosteriorPoint& point) {
  const Eigen::MatrixXd jacobian = posterior.Jacobian(point);
  const Eigen::MatrixXd marginalised = posterior.Metric().Marginalise(jacobian);
  return {posterior.Information(point, jacobian, marginalised),
          posterior.Gradient(point, marginalised)};
}

PosteriorPoint DampedStep(const EffectPosterior& posterior, const PosteriorPoint& point,
                          const NormalEquations& equations, double damping) {
  Eigen::MatrixXd damped = equations.information;
  damped.diagonal() *= 1.0 + damping;
  const Eigen::VectorXd moved = point.scaled - damped.ldlt().solve(equations.gradient);
  return posterior.At(posterior.Parameters().Clamped(moved));
}

}  // namespace

PosteriorPoint MinimiseCost(const EffectPosterior& posterior, PosteriorPoint point) {
  double damping = kInitialDamping;
  for (int iteration = 0; iteration < kDiagnosis.effect_fit.maximum_iterations; ++iteration) {
    const NormalEquations equations = NormalEquationsAt(posterior, point);
    double gained = 0.0;
    while (damping < kMaximumDamping) {
      const PosteriorPoint next = DampedStep(posterior, point, equations, damping);
      if (next.cost < point.cost) {
        gained = point.cost - next.cost;
        point = next;
        damping = std::max(damping / 10.0, kMinimumDamping);
        break;
      }
      damping *= 10.0;
    }
    if (gained < kDiagnosis.effect_fit.converged_gain) break;
  }
  return point;
}

}  // namespace telltale
