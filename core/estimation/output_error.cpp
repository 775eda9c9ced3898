#include "estimation/output_error.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>

#include <ceres/ceres.h>

#include "contract.hpp"
#include "estimation/weak_iv.hpp"
#include "linear_algebra/decompositions.hpp"
#include "median.hpp"
#include "range.hpp"

namespace telltale {
namespace {

constexpr double kLongestTimeConstantS = 20.0;
constexpr double kRoughly = 1e-4;  // relative changes of the sum at which to stop
constexpr double kClosely = 1e-9;
constexpr int kRoughIterations = 15;

std::string Number(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.3g", value);
  return text;
}

/// One shot's share of the sum, as a function of theta and of the state it starts in.
class ShotCost : public ceres::CostFunction {
 public:
  ShotCost(const ShotPlan& plan, const Shot& shot, const SharedUnknowns& unknowns,
           const Yardstick& yardstick)
      : plan_(plan), shot_(shot), unknowns_(unknowns), yardstick_(yardstick) {
    set_num_residuals(static_cast<int>(shot.Residuals()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(unknowns.Size()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(ShotState::SizeAtCompileTime));
  }

  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override {
    const Eigen::Map<const Eigen::VectorXd> theta(parameters[0], unknowns_.Size());
    const Eigen::Map<const ShotState> start(parameters[1]);
    const auto miss =
        Shoot(plan_, shot_, unknowns_, theta, start, yardstick_, jacobians != nullptr);
    if (!miss) return false;
    std::copy_n(miss->residual.data(), miss->residual.size(), residuals);
    if (jacobians == nullptr) return true;
    if (jacobians[0] != nullptr) {
      std::copy_n(miss->by_shared.data(), miss->by_shared.size(), jacobians[0]);
    }
    if (jacobians[1] != nullptr) {
      std::copy_n(miss->by_start.data(), miss->by_start.size(), jacobians[1]);
    }
    return true;
  }

 private:
  const ShotPlan& plan_;
  const Shot& shot_;
  const SharedUnknowns& unknowns_;
  const Yardstick& yardstick_;
};

/// Where theta begins and how far a coefficient may reasonably move from there: by what would take
/// the boat through the spread of its velocities in a second. Data that tell anything overrule it
/// by orders of magnitude; along what they do not tell it keeps theta from wandering off.
struct Leash {
  Eigen::VectorXd centre;
  Eigen::VectorXd weight;  // one over that reach
};

Leash LeashOn(const PreparedDataset& dataset, const SharedUnknowns& unknowns,
              const Eigen::VectorXd& centre) {
  constexpr double kThroughSpreadS = 1.0;
  Leash leash{centre, Eigen::VectorXd::Ones(centre.size())};
  const auto n = static_cast<double>(dataset.rows.size());
  for (const Equation equation : kEquations) {
    const auto regressors = Regressors(equation, unknowns.parameterization);
    Eigen::VectorXd row(static_cast<Eigen::Index>(regressors.size()));
    Eigen::VectorXd squares = Eigen::VectorXd::Zero(row.size());
    double sum = 0.0;
    double square = 0.0;
    for (const PreparedRow& at : dataset.rows) {
      FillRow(equation, unknowns.parameterization, at.nu, unknowns.dead_zone.Apply(at.delta),
              {row.data(), regressors.size()});
      squares += row.cwiseAbs2() / n;
      sum += ComponentOf(at.nu, equation) / n;
      square += ComponentOf(at.nu, equation) * ComponentOf(at.nu, equation) / n;
    }
    const double spread = std::sqrt(std::max(square - sum * sum, 1e-12));
    Eigen::Index next = unknowns.First(equation);
    for (const std::size_t column : unknowns.columns[IndexOf(equation)]) {
      leash.weight[next++] =
          kThroughSpreadS * std::sqrt(squares[static_cast<Eigen::Index>(column)]) / spread;
    }
  }
  return leash;
}

class LeashCost : public ceres::CostFunction {
 public:
  explicit LeashCost(const Leash& leash) : leash_(leash) {
    set_num_residuals(static_cast<int>(leash.centre.size()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(leash.centre.size()));
  }

  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override {
    const Eigen::Index P = leash_.centre.size();
    const Eigen::Map<const Eigen::VectorXd> theta(parameters[0], P);
    Eigen::Map<Eigen::VectorXd>(residuals, P) = leash_.weight.cwiseProduct(theta - leash_.centre);
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      Eigen::Map<RowMajorMatrix>(jacobians[0], P, P) = leash_.weight.asDiagonal();
    }
    return true;
  }

 private:
  const Leash& leash_;
};

/// How many times their usual size values are by their median, at least once.
double TimesUsual(std::vector<double> values, double usual_median) {
  return values.empty() ? 1.0 : std::max(1.0, Median(std::move(values)) / usual_median);
}

/// Theta and the states in which the shots start, moving together towards the least sum.
class Solution {
 public:
  Solution(const ShotPlan& plan, const SharedUnknowns& unknowns, const Leash& leash, double knee,
           const Eigen::VectorXd& theta)
      : plan_(plan), unknowns_(unknowns), leash_(leash), knee_(knee), theta_(theta) {
    for (const Shot& shot : plan.shots) starts_.push_back(shot.guess);
  }

  const Eigen::VectorXd& Theta() const { return theta_; }

  /// Whether some shot cannot be sailed to its end.
  bool RunsAway() const {
    for (std::size_t i = 0; i < plan_.shots.size(); ++i) {
      if (!Sight(i, {}, false)) return true;
    }
    return false;
  }

  std::optional<Miss> Sight(std::size_t shot, const Yardstick& yardstick,
                            bool with_derivatives) const {
    return Shoot(plan_, plan_.shots[shot], unknowns_, theta_, starts_[shot], yardstick,
                 with_derivatives);
  }

  /// The sizes that residuals have now, by their medians, never less than the sensors' noise.
  Yardstick Measure() const {
    constexpr double kMedianDistance = 1.1774;  // of a unit normal in the plane
    constexpr double kMedianSize = 0.6745;      // of a unit normal
    std::vector<double> distances;
    std::vector<double> sizes;
    ForEachResidual([&](const auto& residual) {
      (residual.size() == 2 ? distances : sizes).push_back(residual.norm());
    });
    return {TimesUsual(std::move(distances), kMedianDistance),
            TimesUsual(std::move(sizes), kMedianSize), knee_};
  }

  std::size_t CountPast(const Yardstick& yardstick) const {
    std::size_t past = 0;
    ForEachResidual([&](const auto& residual) {
      const double size = residual.size() == 2 ? yardstick.position : yardstick.heading;
      past += residual.norm() > yardstick.knee * size ? 1 : 0;
    });
    return past;
  }

  /// Moves to the least sum by this yardstick; whether it got there.
  bool Descend(const Yardstick& yardstick, double tolerance, int iterations) {
    ceres::Problem problem;
    auto* order = new ceres::ParameterBlockOrdering;  // the solver's options own it
    problem.AddParameterBlock(theta_.data(), static_cast<int>(theta_.size()));
    order->AddElementToGroup(theta_.data(), 1);
    if (unknowns_.lagging) {
      problem.SetParameterLowerBound(theta_.data(), 0, kLeastTimeConstantS);
      problem.SetParameterUpperBound(theta_.data(), 0, kLongestTimeConstantS);
    }
    for (std::size_t i = 0; i < plan_.shots.size(); ++i) {
      problem.AddResidualBlock(
          std::make_unique<ShotCost>(plan_, plan_.shots[i], unknowns_, yardstick).release(),
          nullptr, theta_.data(), starts_[i].data());
      order->AddElementToGroup(starts_[i].data(), 0);
    }
    problem.AddResidualBlock(std::make_unique<LeashCost>(leash_).release(), nullptr, theta_.data());
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_SCHUR;
    options.linear_solver_ordering.reset(order);
    options.max_num_iterations = iterations;
    options.function_tolerance = tolerance;
    options.parameter_tolerance = 1e-10;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    return summary.termination_type == ceres::CONVERGENCE;
  }

 private:
  /// Visits north-east pairs and headings one by one.
  template <class Visit>
  void ForEachResidual(Visit visit) const {
    for (std::size_t i = 0; i < plan_.shots.size(); ++i) {
      const auto miss = Sight(i, {}, false);
      if (!miss) continue;
      Eigen::Index row = 0;
      for (const ShotNode& node : plan_.shots[i].nodes) {
        if (node.fix) {
          visit(miss->residual.segment(row, 2));
          row += 2;
        }
        if (node.heading) visit(miss->residual.segment(row++, 1));
      }
    }
  }

  const ShotPlan& plan_;
  const SharedUnknowns& unknowns_;
  const Leash& leash_;
  double knee_;
  Eigen::VectorXd theta_;
  std::vector<ShotState> starts_;
};

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
                        const Solution& solution, const Yardstick& yardstick,
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
    theta[0] = std::clamp(theta[0], kLeastTimeConstantS, kLongestTimeConstantS);
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
  Solution From(const Eigen::VectorXd& theta) const {
    Solution straight(plan_, unknowns_, leash_, options_.knee, theta);
    if (Descend(straight)) return straight;
    Solution roundabout(plan_, unknowns_, leash_, options_.knee, ByBriefShots(theta));
    if (roundabout.RunsAway()) return straight;
    Descend(roundabout);
    return roundabout;
  }

 private:
  bool Descend(Solution& solution) const {
    return solution.Descend(solution.Measure(), kRoughly, kRoughIterations);
  }

  /// Sails shots of a quarter and of half the length. The briefest hardly bend and hardly run away,
  /// so that almost any theta leads to one from which full shots can be sailed.
  Eigen::VectorXd ByBriefShots(Eigen::VectorXd theta) const {
    ShotOptions brief = options_.shots;
    for (const double share : {0.25, 0.5}) {
      brief.length_s = share * options_.shots.length_s;
      const ShotPlan plan = CutShots(dataset_, regression_, unknowns_, brief);
      if (Solution(plan, unknowns_, leash_, options_.knee, theta).RunsAway()) {
        theta = unknowns_.In(Unpushed(unknowns_));
      }
      Solution solution(plan, unknowns_, leash_, options_.knee, theta);
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
  Solution solution = Approach(dataset, regression, plan, unknowns, leash, options).From(begin);
  if (solution.RunsAway()) return tl::unexpected(RefuseRunaway());
  // How far residuals reach weighs the sensors against each other, and that moves the residuals.
  solution.Descend(solution.Measure(), kRoughly, options.iterations);
  const Yardstick yardstick = solution.Measure();
  const bool converged = solution.Descend(yardstick, kClosely, options.iterations);

  OutputErrorFit fit = Quantify(plan, unknowns, solution, yardstick, options);
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
  const auto g = static_cast<double>(fit.scores.cols());
  Require(g > 1.0, "at least two clusters");
  Eigen::MatrixXd influence(root.rows(), fit.scores.cols());
  for (Eigen::Index s = 0; s < fit.scores.cols(); ++s) {
    // (H - H_s)^-1 q_s = root (1 - root' H_s root)^-1 root' q_s, within what can be told apart.
    Eigen::MatrixXd left = (kLeastLeft - 1.0) * root.transpose() *
                           fit.cluster_information[static_cast<std::size_t>(s)] * root;
    left.diagonal().array() += 1.0;
    const Eigen::VectorXd right = root.transpose() * fit.scores.col(s);
    influence.col(s) = root * left.llt().solve(right);
  }
  return (g - 1.0) / g * influence * influence.transpose();
}

Eigen::MatrixXd NaiveCovariance(const OutputErrorFit& fit) {
  return fit.residual_variance * fit.separability.root * fit.separability.root.transpose();
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
