#include "baselines/best_bic.hpp"

#include <algorithm>
#include <cmath>

#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"

namespace blind::baselines {
namespace {

using telltale::Effect;
using telltale::EffectParameter;

constexpr double kMostSigmas = 100.0;  // of an error: a lost boat
constexpr double kDerivative = 0.05;   // in typical sizes
constexpr int kMostIterations = 10;
constexpr double kConverged = 1e-4;  // of the sum of squares
constexpr double kMostDamping = 1e4;

/// One effect's parameters, in typical sizes from where they are usual, on a recording.
class Problem {
 public:
  Problem(const ReferenceBasis& basis, const Effect& effect)
      : basis_(basis), effect_(effect), whitener_(basis.nominal.covariance) {}

  Eigen::Index Unknowns() const { return static_cast<Eigen::Index>(effect_.Parameters().size()); }

  telltale::ModelledEffect At(const Eigen::VectorXd& sizes) const {
    telltale::ModelledEffect modelled{&effect_, {}};
    for (Eigen::Index i = 0; i < Unknowns(); ++i) {
      modelled.values.push_back(Of(i).prior_mean + Of(i).typical * sizes[i]);
    }
    return modelled;
  }

  Eigen::VectorXd Within(Eigen::VectorXd sizes) const {
    for (Eigen::Index i = 0; i < Unknowns(); ++i) {
      sizes[i] = std::clamp(sizes[i], (Of(i).lower - Of(i).prior_mean) / Of(i).typical, Highest(i));
    }
    return sizes;
  }

  Eigen::VectorXd Errors(const Eigen::VectorXd& sizes) const {
    Eigen::MatrixXd errors = basis_.runs.Errors(basis_.With({At(sizes)}));
    whitener_.matrixL().solveInPlace(errors);
    return errors.cwiseMax(-kMostSigmas).cwiseMin(kMostSigmas).reshaped();
  }

  Eigen::MatrixXd Jacobian(const Eigen::VectorXd& sizes, const Eigen::VectorXd& errors) const {
    Eigen::MatrixXd jacobian(errors.size(), Unknowns());
    for (Eigen::Index i = 0; i < Unknowns(); ++i) {
      Eigen::VectorXd moved = sizes;
      const double step = sizes[i] + kDerivative > Highest(i) ? -kDerivative : kDerivative;
      moved[i] += step;
      jacobian.col(i) = (Errors(moved) - errors) / step;
    }
    return jacobian;
  }

  /// Each parameter that is zero in a nominal boat at its typical size, either way, and all at
  /// nothing.
  std::vector<Eigen::VectorXd> Starts() const {
    std::vector<Eigen::VectorXd> starts{Eigen::VectorXd::Zero(Unknowns())};
    for (Eigen::Index i = 0; i < Unknowns(); ++i) {
      if (Of(i).is_shape) continue;
      for (const double size : {-1.0, 1.0}) {
        starts.push_back(Within(size * Eigen::VectorXd::Unit(Unknowns(), i)));
      }
    }
    return starts;
  }

 private:
  const EffectParameter& Of(Eigen::Index i) const {
    return effect_.Parameters()[static_cast<std::size_t>(i)];
  }
  double Highest(Eigen::Index i) const { return (Of(i).upper - Of(i).prior_mean) / Of(i).typical; }

  const ReferenceBasis& basis_;
  const Effect& effect_;
  Eigen::LLT<Eigen::MatrixXd> whitener_;
};

struct Point {
  Eigen::VectorXd sizes;
  Eigen::VectorXd errors;
  double SquaredMahalanobis() const { return errors.squaredNorm(); }
};

/// Levenberg-Marquardt from the best of the starts.
Point LeastSquares(const Problem& problem) {
  const auto at = [&](const Eigen::VectorXd& sizes) { return Point{sizes, problem.Errors(sizes)}; };
  Point best = at(problem.Starts().front());
  for (const Eigen::VectorXd& start : problem.Starts()) {
    if (Point other = at(start); other.SquaredMahalanobis() < best.SquaredMahalanobis())
      best = std::move(other);
  }
  double damping = 1e-3;
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    const Eigen::MatrixXd jacobian = problem.Jacobian(best.sizes, best.errors);
    const Eigen::MatrixXd information = jacobian.transpose() * jacobian;
    const Eigen::VectorXd slope = jacobian.transpose() * best.errors;
    const double before = best.SquaredMahalanobis();
    for (; damping < kMostDamping && best.SquaredMahalanobis() == before; damping *= 10.0) {
      Eigen::MatrixXd damped = information;
      damped.diagonal() += damping * (information.diagonal().array() + 1e-9).matrix();
      Point next = at(problem.Within(best.sizes - damped.ldlt().solve(slope)));
      if (next.SquaredMahalanobis() >= before) continue;
      best = std::move(next);
      damping /= 100.0;
    }
    if (before - best.SquaredMahalanobis() < kConverged * before) break;
  }
  return best;
}

}  // namespace

std::vector<ScoredExplanation> BestBic(const ReferenceBasis& basis) {
  std::vector<ScoredExplanation> explanations;
  for (const Effect* effect : basis.candidates) {
    if (telltale::EffectParameterRefsOf(std::span(&effect, 1)).empty()) continue;
    const Problem problem(basis, *effect);
    const Point point = LeastSquares(problem);
    const auto n = static_cast<double>(point.errors.size());
    const double bic = n * std::log(point.SquaredMahalanobis() / n) +
                       static_cast<double>(problem.Unknowns()) * std::log(n);
    explanations.push_back({{problem.At(point.sizes)}, bic});
  }
  return explanations;
}

}  // namespace blind::baselines
