#include "telltale/core/estimation/output_error.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "telltale/core/contract.hpp"
#include "telltale/core/estimation/shot_solution.hpp"
#include "telltale/core/estimation/weak_iv.hpp"
#include "telltale/core/linear_algebra/covariance.hpp"
#include "telltale/core/linear_algebra/decompositions.hpp"
#include "telltale/core/range.hpp"

namespace telltale {
namespace {

constexpr double kRoughly = 1e-4;  // relative changes of the sum at which to stop
constexpr double kClosely = 1e-9;
constexpr int kRoughIterations = 15;

std::string Number(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.3g", value);
  return text;
}

/// What a shot says of the shared unknowns once its own state has been fitted out of it: rows
/// orthogonal to the columns of the state.
struct Eliminated {
  Eigen::MatrixXd by_shared;
  Eigen::VectorXd residual;
};

Eliminated Eliminate(const Miss& miss) {
  const Eigen::Index spare = miss.residual.size() - miss.by_start.cols();
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(miss.by_start);
  Eigen::MatrixXd both(miss.residual.size(), miss.by_shared.cols() + 1);
  both << miss.by_shared, miss.residual;
  both.applyOnTheLeft(qr.householderQ().adjoint());
  return {both.bottomLeftCorner(spare, miss.by_shared.cols()), both.rightCols(1).bottomRows(spare)};
}

OutputErrorFit Quantify(const ShotPlan& plan, const SharedUnknowns& unknowns,
                        const ShotSolution& solution, const Yardstick& yardstick,
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
  for (std::size_t i = 0; i < plan.shots.size(); ++i) {
    const auto miss = solution.Sight(i, yardstick, true);
    Require(miss.has_value(), "a solution that does not run away");
    const Eliminated own = Eliminate(*miss);
    const std::size_t cluster = plan.shots[i].cluster;
    fit.cluster_information[cluster].noalias() += own.by_shared.transpose() * own.by_shared;
    fit.scores.col(static_cast<Eigen::Index>(cluster)).noalias() -=
        own.by_shared.transpose() * own.residual;
    raw += miss->by_shared.colwise().squaredNorm().transpose();
    squares += own.residual.squaredNorm();
    spare += static_cast<double>(own.residual.size());
    fit.residuals += static_cast<std::size_t>(miss->residual.size());
  }
  for (const Eigen::MatrixXd& H : fit.cluster_information) fit.information += H;
  fit.separability = Separate(fit.information, raw, options.inseparable_condition_index);
  fit.degrees_of_freedom = spare;
  fit.residual_variance = squares / spare;
  fit.position_misfit = yardstick.position;
  fit.heading_misfit = yardstick.heading;
  fit.shots = plan.shots.size();
  fit.past_knee = solution.CountPast(yardstick);
  return fit;
}

std::optional<Refusal> RefuseThin(const ShotPlan& plan, const SharedUnknowns& unknowns) {
  Eigen::Index spare = -unknowns.Size();
  for (const Shot& shot : plan.shots) {
    spare += shot.Residuals() - static_cast<Eigen::Index>(ShotState::SizeAtCompileTime);
  }
  if (!plan.shots.empty() && plan.clusters > 1 && spare > 0) return std::nullopt;
  return Refusal{"output error",
                 "the recording gives " + Number(static_cast<double>(plan.shots.size())) +
                     " shots with enough fixes and headings, too few for " +
                     Number(static_cast<double>(unknowns.Size())) + " coefficients",
                 "record for longer with the propellers in the regions these equations use"};
}

Refusal RefuseRunaway() {
  return {"output error", "no model was found that stays near the boat for as long as a shot lasts",
          "give shorter shots, or record more of the manoeuvres in which the model runs away"};
}

VesselModel Unpushed(const SharedUnknowns& unknowns) {
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
    theta[0] = std::clamp(theta[0], kLeastTimeConstantS, kLongestLagS);
  }
  return theta;
}

/// The way from a start to near the least sum.
class Approach {
 public:
  Approach(const PreparedDataset& dataset, const RegressionOptions& regression,
           const ShotPlan& plan, const SharedUnknowns& unknowns, const Leash& leash,
           const OutputErrorOptions& options)
      : dataset_(dataset),
        regression_(regression),
        plan_(plan),
        unknowns_(unknowns),
        leash_(leash),
        options_(options) {}

  /// Straight from `theta` where that leads there soon, as it does from a good start; else by brief
  /// shots.
  ShotSolution From(const Eigen::VectorXd& theta) const {
    ShotSolution straight(plan_, unknowns_, leash_, options_.knee, theta);
    if (Descend(straight)) return straight;
    ShotSolution roundabout(plan_, unknowns_, leash_, options_.knee, ByBriefShots(theta));
    if (roundabout.RunsAway()) return straight;
    Descend(roundabout);
    return roundabout;
  }

 private:
  bool Descend(ShotSolution& solution) const {
    return solution.Descend(solution.Measure(), kRoughly, kRoughIterations);
  }

  /// Sails shots of a quarter and of half the length. The briefest hardly bend and hardly run away,
  /// so that almost any theta leads to one from which full shots can be sailed.
  Eigen::VectorXd ByBriefShots(Eigen::VectorXd theta) const {
    ShotOptions brief = options_.shots;
    for (const double share : {0.25, 0.5}) {
      brief.length_s = share * options_.shots.length_s;
      const ShotPlan plan = CutShots(dataset_, regression_, unknowns_, brief);
      if (ShotSolution(plan, unknowns_, leash_, options_.knee, theta).RunsAway()) {
        theta = unknowns_.In(Unpushed(unknowns_));
      }
      ShotSolution solution(plan, unknowns_, leash_, options_.knee, theta);
      Descend(solution);
      theta = solution.Theta();
    }
    return theta;
  }

  const PreparedDataset& dataset_;
  const RegressionOptions& regression_;
  const ShotPlan& plan_;
  const SharedUnknowns& unknowns_;
  const Leash& leash_;
  const OutputErrorOptions& options_;
};

}  // namespace

std::optional<Refusal> OutputErrorOptions::Validate() const {
  const std::string_view subject = "output error";
  const std::array checks = {
      OutOfRange(subject, "shots.length_s", shots.length_s, 2.0, 60.0),
      OutOfRange(subject, "knee", knee, 1.0, 100.0),
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
  const ShotPlan plan = CutShots(dataset, regression, unknowns, options.shots);
  if (auto refusal = RefuseThin(plan, unknowns)) return tl::unexpected(*std::move(refusal));

  // Far from the least sum, residuals say little of which measurement is wild: roughly there first.
  const Eigen::VectorXd begin = InBounds(unknowns, unknowns.In(start));
  const Leash leash = LeashOn(dataset, unknowns, begin);
  ShotSolution solution = Approach(dataset, regression, plan, unknowns, leash, options).From(begin);
  if (solution.RunsAway()) return tl::unexpected(RefuseRunaway());
  // How far residuals reach weighs the sensors against each other, and that moves the residuals.
  solution.Descend(solution.Measure(), kRoughly, options.iterations);
  const Yardstick yardstick = solution.Measure();
  const bool converged = solution.Descend(yardstick, kClosely, options.iterations);

  OutputErrorFit fit = Quantify(plan, unknowns, solution, yardstick, options);
  fit.begin = begin;
  fit.starts = solution.Starts();
  fit.converged = converged;
  return fit;
}

VesselModel StartOf(const PreparedDataset& dataset, const RegressionOptions& regression,
                    const std::array<std::vector<std::size_t>, 3>& columns) {
  const auto weak = EstimateWeakIv(dataset, regression, columns, {});
  if (weak) return ModelOf(*weak, weak->Damped(), dataset.sampling_period_s);
  return Unpushed(UnknownsOf(regression, columns));
}

Eigen::MatrixXd ClusterCovariance(const OutputErrorFit& fit) {
  // A cluster that alone tells of some direction would leave nothing of it.
  constexpr double kLeastLeft = 0.02;
  const Eigen::MatrixXd& root = fit.separability.root;
  const Eigen::MatrixXd across = root.transpose();
  const auto g = static_cast<double>(fit.scores.cols());
  Require(g > 1.0, "at least two clusters");
  Eigen::MatrixXd influence(root.rows(), fit.scores.cols());
  for (Eigen::Index s = 0; s < fit.scores.cols(); ++s) {
    // (H - H_s)^-1 q_s = root (1 - root' H_s root)^-1 root' q_s, within what can be told apart.
    Eigen::MatrixXd left =
        (kLeastLeft - 1.0) * Mapped(across, fit.cluster_information[static_cast<std::size_t>(s)]);
    left.diagonal().array() += 1.0;
    const Eigen::VectorXd right = across * fit.scores.col(s);
    influence.col(s) = root * left.llt().solve(right);
  }
  return (g - 1.0) / g * OfRoot(influence);
}

Eigen::MatrixXd NaiveCovariance(const OutputErrorFit& fit) {
  return fit.residual_variance * OfRoot(fit.separability.root);
}

double Misspecification(const OutputErrorFit& fit) {
  const Eigen::VectorXd clustered = ClusterCovariance(fit).diagonal();
  const Eigen::VectorXd naive = NaiveCovariance(fit).diagonal();
  double worst = 0.0;
  for (const Equation equation : kEquations) {
    const Eigen::Index first = fit.unknowns.First(equation);
    const auto size = static_cast<Eigen::Index>(fit.unknowns.columns[IndexOf(equation)].size());
    double sum = 0.0;
    double count = 0.0;
    for (Eigen::Index j = first; j < first + size; ++j) {
      if (!fit.separability.separable[static_cast<std::size_t>(j)]) continue;
      sum += 0.5 * std::log(clustered[j] / naive[j]);
      count += 1.0;
    }
    if (count > 0.0) worst = std::max(worst, std::exp(sum / count));
  }
  return worst;
}

bool LagIsAtItsLeast(const OutputErrorFit& fit) {
  return fit.unknowns.lagging && fit.theta[0] <= 1.001 * kLeastTimeConstantS;
}

std::string NameOf(const SharedUnknowns& unknowns, std::size_t unknown) {
  Require(unknown < static_cast<std::size_t>(unknowns.Size()), "one of the unknowns");
  if (unknowns.lagging && unknown == 0) return "thruster time constant";
  for (const Equation equation : {Equation::kYaw, Equation::kSway, Equation::kSurge}) {
    const auto first = static_cast<std::size_t>(unknowns.First(equation));
    if (unknown < first) continue;
    const std::size_t column = unknowns.columns[IndexOf(equation)][unknown - first];
    return std::string(Name(equation)) + " " +
           std::string(Regressors(equation, unknowns.parameterization)[column].name);
  }
  return {};
}

Refusal Explain(const InseparableDirection& direction, const SharedUnknowns& unknowns) {
  constexpr std::size_t kNamed = 6;
  std::string names;
  std::string change;
  for (std::size_t i = 0; i < std::min(kNamed, direction.unknowns.size()); ++i) {
    const std::size_t unknown = direction.unknowns[i];
    const std::string name = NameOf(unknowns, unknown);
    const double by = direction.change[static_cast<Eigen::Index>(unknown)];
    names += (names.empty() ? "" : ", ") + name;
    change += (change.empty() ? "" : ", ") + Number(by) + " to " + name;
  }
  if (direction.unknowns.size() > kNamed) {
    const auto rest = static_cast<double>(direction.unknowns.size() - kNamed);
    change += " and something to " + Number(rest) + " others";
  }
  if (direction.unknowns.size() == 1) {
    return {names, "the data say nothing of it: no measurement moves with it alone",
            "record manoeuvres in which this term is at work"};
  }
  return {names,
          "these cannot be told apart: adding " + change +
              " leaves every measurement as it is (condition index " +
              Number(direction.condition_index) + ")",
          "add steps of the command between small and full, zigzags and circles at two or more "
          "speeds"};
}

}  // namespace telltale
