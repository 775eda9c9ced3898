#include "telltale/core/estimation/output_error/output_error.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/base/format_number.hpp"
#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/base/range.hpp"
#include "telltale/core/estimation/output_error/shooting_solution.hpp"
#include "telltale/core/estimation/weak_form/weak_iv.hpp"
#include "telltale/core/vessel/thruster_response.hpp"

namespace telltale {
namespace {

// Relative changes of the sum of squares at which a descent stops.
constexpr double kRoughTolerance = 1e-4;
constexpr double kFineTolerance = 1e-9;
constexpr int kRoughIterations = 15;

/// The rows of a shooting segment, orthogonal to the columns of its initial state: what remains for
/// the shared unknowns once the state has been fitted.
struct Eliminated {
  Eigen::MatrixXd by_shared;
  Eigen::VectorXd residual;
};

Eliminated Eliminate(const ShootingResidual& shooting_residual) {
  const Eigen::Index spare = shooting_residual.residual.size() - shooting_residual.by_start.cols();
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(shooting_residual.by_start);
  Eigen::MatrixXd both(shooting_residual.residual.size(), shooting_residual.by_shared.cols() + 1);
  both << shooting_residual.by_shared, shooting_residual.residual;
  both.applyOnTheLeft(qr.householderQ().adjoint());
  return {both.bottomLeftCorner(spare, shooting_residual.by_shared.cols()),
          both.rightCols(1).bottomRows(spare)};
}

OutputErrorFit Quantify(const ShootingPlan& plan, const SharedUnknowns& unknowns,
                        const ShootingSolution& solution, const NoiseScale& noise_scale,
                        const OutputErrorOptions& options) {
  const Eigen::Index P = unknowns.Size();
  OutputErrorFit fit;
  fit.unknowns = unknowns;
  fit.theta = solution.Theta();
  fit.information = Eigen::MatrixXd::Zero(P, P);
  fit.scores = Eigen::MatrixXd::Zero(P, static_cast<Eigen::Index>(plan.clusters));
  fit.cluster_information.assign(plan.clusters, Eigen::MatrixXd::Zero(P, P));
  Eigen::VectorXd raw = Eigen::VectorXd::Zero(P);
  double squares = 0.0;
  double spare = -static_cast<double>(P);
  for (std::size_t i = 0; i < plan.shooting_segments.size(); ++i) {
    const auto shooting_residual = solution.ComputeResidual(i, noise_scale, true);
    Require(shooting_residual.has_value(), "a solution that does not diverge");
    const Eliminated own = Eliminate(*shooting_residual);
    const std::size_t cluster = plan.shooting_segments[i].cluster;
    fit.cluster_information[cluster].noalias() += own.by_shared.transpose() * own.by_shared;
    fit.scores.col(static_cast<Eigen::Index>(cluster)).noalias() -=
        own.by_shared.transpose() * own.residual;
    raw += shooting_residual->by_shared.colwise().squaredNorm().transpose();
    squares += own.residual.squaredNorm();
    spare += static_cast<double>(own.residual.size());
    fit.residuals += static_cast<std::size_t>(shooting_residual->residual.size());
  }
  for (const Eigen::MatrixXd& H : fit.cluster_information) fit.information += H;
  fit.separability = Separate(fit.information, raw, options.inseparable_condition_index);
  fit.degrees_of_freedom = spare;
  fit.residual_variance = squares / spare;
  fit.position_misfit = noise_scale.position;
  fit.heading_misfit = noise_scale.heading;
  fit.shooting_segments = plan.shooting_segments.size();
  fit.beyond_huber_threshold = solution.CountBeyondThreshold(noise_scale);
  return fit;
}

std::optional<Refusal> RefuseThin(const ShootingPlan& plan, const SharedUnknowns& unknowns) {
  Eigen::Index spare = -unknowns.Size();
  for (const ShootingSegment& shooting_segment : plan.shooting_segments) {
    spare +=
        shooting_segment.Residuals() - static_cast<Eigen::Index>(ShootingState::SizeAtCompileTime);
  }
  if (!plan.shooting_segments.empty() && plan.clusters > 1 && spare > 0) return std::nullopt;
  return Refusal{"output error",
                 "the recording gives " +
                     FormatSignificant(static_cast<double>(plan.shooting_segments.size()), 3) +
                     " shooting segments with enough fixes and headings, too few for " +
                     FormatSignificant(static_cast<double>(unknowns.Size()), 3) + " coefficients",
                 "record for longer with the propellers in the regions these equations use"};
}

Refusal RefuseDivergence() {
  return {"output error", "every model found diverges from the boat within a shooting segment",
          "use shorter shooting segments, or record more of the manoeuvres in which the model "
          "diverges"};
}

VesselModel ZeroForceModel(const SharedUnknowns& unknowns) {
  Eigen::VectorXd theta = Eigen::VectorXd::Zero(unknowns.Size());
  constexpr double kUsualTimeConstantS = 0.2;
  if (unknowns.lagging) theta[0] = kUsualTimeConstantS;
  return unknowns.ModelWith(theta, 0.0);
}

SharedUnknowns UnknownsOf(const RegressionOptions& regression,
                          const std::array<std::vector<std::size_t>, 3>& columns) {
  const bool lagging = regression.structure == Structure::kFirstOrderDynamic;
  return {regression.parameterization, regression.dead_zone, lagging, columns};
}

Eigen::VectorXd InBounds(const SharedUnknowns& unknowns, Eigen::VectorXd theta) {
  if (unknowns.lagging) {
    theta[0] = std::clamp(theta[0], kShortestTimeConstantS, kLongestTimeConstantS);
  }
  return theta;
}

/// The descent from a start to the neighbourhood of the least sum of squares.
class InitialDescent {
 public:
  InitialDescent(const PreparedDataset& dataset, const RegressionOptions& regression,
                 const ShootingPlan& plan, const SharedUnknowns& unknowns,
                 const RidgePrior& ridge_prior, const OutputErrorOptions& options)
      : dataset_(dataset),
        regression_(regression),
        plan_(plan),
        unknowns_(unknowns),
        ridge_prior_(ridge_prior),
        options_(options) {}

  /// Directly from `theta` where that converges soon, as it does from a good start; else by way of
  /// shorter shooting segments.
  ShootingSolution From(const Eigen::VectorXd& theta) const {
    ShootingSolution direct(plan_, unknowns_, ridge_prior_, options_.huber_threshold, theta);
    if (Descend(direct)) return direct;
    ShootingSolution by_short_segments(plan_, unknowns_, ridge_prior_, options_.huber_threshold,
                                       FromShortSegments(theta));
    if (by_short_segments.Diverges()) return direct;
    Descend(by_short_segments);
    return by_short_segments;
  }

 private:
  bool Descend(ShootingSolution& solution) const {
    return solution.Descend(solution.Measure(), kRoughTolerance, kRoughIterations);
  }

  /// Fits shooting segments of a quarter and then of half the length. The shortest are nearly
  /// linear and hardly diverge, so almost any theta leads to one that simulates full segments.
  Eigen::VectorXd FromShortSegments(Eigen::VectorXd theta) const {
    ShootingOptions shorter = options_.shooting_segments;
    for (const double share : {0.25, 0.5}) {
      shorter.length_s = share * options_.shooting_segments.length_s;
      const ShootingPlan plan = CutShootingSegments(dataset_, regression_, unknowns_, shorter);
      if (ShootingSolution(plan, unknowns_, ridge_prior_, options_.huber_threshold, theta)
              .Diverges()) {
        theta = unknowns_.In(ZeroForceModel(unknowns_));
      }
      ShootingSolution solution(plan, unknowns_, ridge_prior_, options_.huber_threshold, theta);
      Descend(solution);
      theta = solution.Theta();
    }
    return theta;
  }

  const PreparedDataset& dataset_;
  const RegressionOptions& regression_;
  const ShootingPlan& plan_;
  const SharedUnknowns& unknowns_;
  const RidgePrior& ridge_prior_;
  const OutputErrorOptions& options_;
};

}  // namespace

std::optional<Refusal> OutputErrorOptions::Validate() const {
  const std::string_view subject = "output error";
  const std::array checks = {
      OutOfRange(subject, "shooting_segments.length_s", shooting_segments.length_s, 2.0, 60.0),
      OutOfRange(subject, "huber_threshold", huber_threshold, 1.0, 100.0),
      OutOfRange(subject, "inseparable_condition_index", inseparable_condition_index, 10.0, 1e6),
      OutOfRange(subject, "iterations", iterations, 1.0, 1000.0)};
  for (const auto& refusal : checks) {
    if (refusal) return refusal;
  }
  return std::nullopt;
}

Result<OutputErrorFit> EstimateOutputError(const PreparedDataset& dataset,
                                           const RegressionOptions& regression,
                                           const std::array<std::vector<std::size_t>, 3>& columns,
                                           const VesselModel& start,
                                           const OutputErrorOptions& options) {
  if (auto refusal = options.Validate()) return tl::unexpected(*std::move(refusal));
  const SharedUnknowns unknowns = UnknownsOf(regression, columns);
  Require(unknowns.Size() > (unknowns.lagging ? 1 : 0), "at least one coefficient to seek");
  const ShootingPlan plan =
      CutShootingSegments(dataset, regression, unknowns, options.shooting_segments);
  if (auto refusal = RefuseThin(plan, unknowns)) return tl::unexpected(*std::move(refusal));

  // Far from the least sum, residuals do not show which measurements are outliers, so a rough
  // descent comes first.
  const Eigen::VectorXd begin = InBounds(unknowns, unknowns.In(start));
  const RidgePrior ridge_prior = MakeRidgePrior(dataset, unknowns, begin);
  ShootingSolution solution =
      InitialDescent(dataset, regression, plan, unknowns, ridge_prior, options).From(begin);
  if (solution.Diverges()) return tl::unexpected(RefuseDivergence());
  // The noise scale depends on the residuals, and the residuals on the noise scale: two rounds.
  solution.Descend(solution.Measure(), kRoughTolerance, options.iterations);
  const NoiseScale noise_scale = solution.Measure();
  const bool converged = solution.Descend(noise_scale, kFineTolerance, options.iterations);

  OutputErrorFit fit = Quantify(plan, unknowns, solution, noise_scale, options);
  fit.begin = begin;
  fit.starts = solution.Starts();
  fit.converged = converged;
  return fit;
}

VesselModel StartOf(const PreparedDataset& dataset, const RegressionOptions& regression,
                    const std::array<std::vector<std::size_t>, 3>& columns) {
  const auto weak = EstimateWeakIv(dataset, regression, columns, {});
  if (weak) return ModelOf(*weak, weak->Regularised(), dataset.sampling_period_s);
  return ZeroForceModel(UnknownsOf(regression, columns));
}

bool LagIsAtLowerBound(const OutputErrorFit& fit) {
  return fit.unknowns.lagging && fit.theta[0] <= 1.001 * kShortestTimeConstantS;
}

}  // namespace telltale
