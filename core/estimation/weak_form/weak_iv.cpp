#include "telltale/core/estimation/weak_form/weak_iv.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/base/linear_algebra/covariance.hpp"
#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/estimation/regression/residual_autocovariance.hpp"
#include "telltale/core/estimation/weak_form/instruments.hpp"
#include "telltale/core/estimation/weak_form/residual_whitening.hpp"
#include "telltale/core/estimation/weak_form/stacked_system.hpp"
#include "telltale/core/vessel/thruster_response.hpp"

namespace telltale {
namespace {

constexpr double kLeastSquares = 1e-300;  // of residuals, so that logarithms and weights are finite
constexpr double kDelayPriorS = 0.15;     // one sigma, as that of the physical form

Eigen::VectorXd ResidualOf(const ProjectedEquation& equation, const Eigen::VectorXd& theta) {
  return equation.b - equation.G * theta;
}

/// The whitening of an equation's residuals. It takes half of their variance for white, since their
/// whole autocorrelation suits only a boat that moves exactly as the model says. The fewer supports
/// there are for each coefficient, the less their autocorrelation counts.
ResidualWhitening WhiteningOf(const WeakProblem& problem, const ProjectedEquation& equation,
                              const Eigen::VectorXd& theta) {
  constexpr Eigen::Index kOrder = 10;
  constexpr double kSupportsPerCoefficient = 10.0;
  const auto& [index, columns, G, b] = equation;
  const auto runs = RunsOf(problem.supports[index].first_rows, problem.phi.stride);
  Eigen::VectorXd shown =
      DefiniteAutocovariance(runs, ResidualOf(equation, theta), kSupportResidualLags);
  const double few =
      kSupportsPerCoefficient * static_cast<double>(G.cols()) / static_cast<double>(G.rows());
  shown.tail(shown.size() - 1) /= 2.0 + few;
  return {runs, shown.head(kOrder + 1)};
}

ProjectedEquation Whitened(const ResidualWhitening& whitening, const ProjectedEquation& equation) {
  return {equation.index, equation.columns, whitening.Whiten(equation.G),
          whitening.Whiten(equation.b)};
}

/// One over the equation's residual variance.
double ResidualWeight(const ProjectedEquation& equation, const Eigen::VectorXd& theta) {
  const Eigen::VectorXd e = ResidualOf(equation, theta);
  return static_cast<double>(e.size()) / std::max(e.squaredNorm(), kLeastSquares);
}

double LeastSquaresMisfit(const ProjectedEquations& equations) {
  double misfit = 0.0;
  const Thetas thetas = SolveLeastSquares(equations);
  for (std::size_t i = 0; i < equations.size(); ++i) {
    const Eigen::VectorXd e = ResidualOf(equations[i], thetas[i]);
    misfit += std::log(std::max(e.squaredNorm(), kLeastSquares));
  }
  return misfit;
}

/// The time constant from which Gauss-Newton starts: the best of a grid by least squares.
double StartingLag(const PreparedDataset& dataset, const WeakProblem& problem,
                   const std::array<std::vector<std::size_t>, 3>& columns) {
  double best = 0.1;
  double least = std::numeric_limits<double>::infinity();
  for (const double tau : {0.05, 0.1, 0.2, 0.4, 0.8, 1.6, 3.2}) {
    const double misfit = LeastSquaresMisfit(
        ProjectEquations(dataset, problem, FilterThrust(dataset, problem, tau), columns));
    if (misfit < least) {
      least = misfit;
      best = tau;
    }
  }
  return best;
}

/// The iteration of EstimateWeakIv(): simulate the instruments, whiten, solve.
class WeakIvIteration {
 public:
  WeakIvIteration(const PreparedDataset& dataset, const WeakProblem& problem,
                  const std::array<std::vector<std::size_t>, 3>& columns,
                  const WeakIvOptions& options, bool lagging)
      : dataset_(dataset),
        problem_(problem),
        columns_(columns),
        options_(options),
        instruments_(dataset, problem) {
    if (lagging) time_constant_s_ = StartingLag(dataset, problem, columns);
    thrust_ = FilterThrust(dataset, problem, time_constant_s_);
    equations_ = ProjectEquations(dataset, problem, thrust_, columns);
    Require(!equations_.empty(), "at least one equation with coefficients to seek");
  }

  bool IsOverdetermined() const {
    return std::ranges::all_of(equations_, [](const ProjectedEquation& equation) {
      return equation.G.rows() > equation.G.cols();
    });
  }

  /// Least squares, from which the first instruments are simulated.
  void Start() {
    for (const ProjectedEquation& equation : equations_) {
      regularised_.push_back(SolveRegularised(equation, equation.G, options_.ridge));
    }
    thetas_ = regularised_;
  }

  /// One iteration; false when the instruments do not determine every unknown.
  bool Iterate() {
    LeaveLastRound();
    auto predicted = instruments_.Predict(
        ModelWith(problem_, equations_, regularised_),
        ConstantDisturbancesWith(problem_, equations_, regularised_), columns_, thrust_);
    const std::vector<Eigen::MatrixXd> by_lag = ByLag();
    system_ = StackedSystem(Unknowns());
    for (std::size_t i = 0; i < equations_.size(); ++i) {
      AddEquation(std::move(predicted[equations_[i].index]), by_lag[i]);
    }
    if (options_.delays) {
      system_.A.diagonal().tail<kDelays>().array() += 1.0 / (kDelayPriorS * kDelayPriorS);
    }
    auto inverse = InvertScaled(system_.A);
    if (!inverse) return false;
    inverse_ = *std::move(inverse);
    const Eigen::VectorXd solution = inverse_ * system_.c;
    UnstackThetas(solution, time_constant_s_ ? 1 : 0, thetas_);
    if (options_.delays) delays_s_ = solution.tail<kDelays>();
    if (time_constant_s_) ChangeTimeConstant(solution[0]);
    return true;
  }

  /// The fit after the last iteration, which is over: what only another one would need makes room.
  WeakFit Fit() && {
    thrust_ = {};
    WeakFit fit;
    fit.problem = problem_;
    fit.time_constant_s = time_constant_s_;
    const Eigen::Index unknowns = inverse_.rows();
    fit.bread = inverse_.topRows(options_.delays ? unknowns - kDelays : unknowns);
    fit.theta.resize(fit.bread.rows());
    fit.scores = Eigen::MatrixXd::Zero(unknowns, static_cast<Eigen::Index>(problem_.clusters));
    Eigen::MatrixXd meat = Eigen::MatrixXd::Zero(unknowns, unknowns);
    Eigen::Index next = 0;
    if (time_constant_s_) fit.theta[next++] = *time_constant_s_;
    for (std::size_t i = 0; i < equations_.size(); ++i) {
      const std::size_t index = equations_[i].index;
      const auto& [places, Z] = system_.equations[i];
      fit.theta.segment(next, thetas_[i].size()) = thetas_[i];
      next += thetas_[i].size();
      WeakEstimate estimate = EstimateOf(i);
      const Eigen::VectorXd innovations = whitenings_[i].Whiten(estimate.residual);
      AddScores(problem_.supports[index].clusters, places, Z, innovations, fit.scores);
      meat(places, places) += StationaryMeat(problem_, index, innovations, Z);
      fit.equations[index] = std::move(estimate);
    }
    fit.stationary_covariance = Mapped(fit.bread, meat);
    if (options_.delays) fit.delays = {delays_s_, OfDelays(fit.scores)};
    return fit;
  }

 private:
  static constexpr Eigen::Index kDelays = DelayDerivatives::kDelays;

  /// What is as large as the data would stand in memory beside its successors.
  void LeaveLastRound() {
    filtering_losses_.clear();
    by_delay_.clear();
    whitenings_.clear();
    system_ = {};
  }

  StackedUnknowns Unknowns() const {
    StackedUnknowns unknowns{time_constant_s_ ? 1 : 0, 0, options_.delays ? kDelays : 0};
    for (const ProjectedEquation& equation : equations_) unknowns.coefficients += equation.G.cols();
    return unknowns;
  }

  /// The derivative of each equation by the time constant; without columns where it is not sought.
  std::vector<Eigen::MatrixXd> ByLag() const {
    if (!time_constant_s_) return std::vector<Eigen::MatrixXd>(equations_.size());
    return LagDerivatives(dataset_, problem_, equations_, thetas_, *time_constant_s_);
  }

  /// The next equation with its filtering loss, whitened, becomes a part of the system.
  void AddEquation(PredictedSupports predicted, const Eigen::MatrixXd& by_lag) {
    const std::size_t i = system_.equations.size();
    filtering_losses_.push_back(std::move(predicted.filtering_loss));
    by_delay_.push_back(std::move(predicted.by_delay));
    const ProjectedEquation completed = Completed(i);
    const ResidualWhitening& whitening =
        whitenings_.emplace_back(WhiteningOf(problem_, completed, thetas_[i]));
    const ProjectedEquation white = Whitened(whitening, completed);
    const Eigen::MatrixXd Z = whitening.Whiten(predicted.Z);
    SharedDerivatives shared;
    if (time_constant_s_) shared.by_lag = whitening.Whiten(by_lag);
    if (options_.delays) shared.by_delay = whitening.Whiten(by_delay_[i]);
    system_.Add(white, Z, shared, ResidualWeight(white, thetas_[i]));
    regularised_[i] = SolveRegularised(white, Z, options_.ridge);
  }

  /// An equation with the filtering loss that the model predicts added to G.
  ProjectedEquation Completed(std::size_t i) const {
    ProjectedEquation completed = equations_[i];
    completed.G += filtering_losses_[i];
    return completed;
  }

  /// The covariance of the delays from the scores of the clusters.
  Eigen::Matrix2d OfDelays(const Eigen::MatrixXd& scores) const {
    const auto g = static_cast<double>(scores.cols());
    return g / std::max(g - 1.0, 1.0) * OfRoot(inverse_.bottomRows(kDelays) * scores);
  }

  /// A Gauss-Newton step, bounded so that one step at most halves or doubles the time constant.
  void ChangeTimeConstant(double step) {
    const double change = std::clamp(step, -0.5 * *time_constant_s_, *time_constant_s_);
    time_constant_s_ =
        std::clamp(*time_constant_s_ + change, kShortestTimeConstantS, kLongestTimeConstantS);
    thrust_ = FilterThrust(dataset_, problem_, time_constant_s_);
    equations_ = ProjectEquations(dataset_, problem_, thrust_, columns_);
  }

  WeakEstimate EstimateOf(std::size_t i) const {
    const Eigen::MatrixXd& Z = system_.equations[i].Z;
    ProjectedEquation completed = Completed(i);
    Eigen::VectorXd residual = ResidualOf(completed, thetas_[i]);
    if (options_.delays) residual -= by_delay_[i] * delays_s_;
    return {std::move(completed.columns),
            thetas_[i],
            regularised_[i],
            std::move(completed.G),
            whitenings_[i].WhitenBack(Z.middleCols(time_constant_s_ ? 1 : 0, thetas_[i].size())),
            std::move(residual)};
  }

  static void AddScores(const std::vector<RowRange>& clusters,
                        const std::vector<Eigen::Index>& places, const Eigen::MatrixXd& Z,
                        const Eigen::VectorXd& innovations, Eigen::MatrixXd& scores) {
    for (std::size_t s = 0; s < clusters.size(); ++s) {
      const auto begin = static_cast<Eigen::Index>(clusters[s].begin);
      const auto count = static_cast<Eigen::Index>(clusters[s].size());
      scores(places, static_cast<Eigen::Index>(s)) +=
          Z.middleRows(begin, count).transpose() * innovations.segment(begin, count);
    }
  }

  const PreparedDataset& dataset_;
  const WeakProblem& problem_;
  const std::array<std::vector<std::size_t>, 3>& columns_;
  const WeakIvOptions& options_;
  Instruments instruments_;
  std::optional<double> time_constant_s_;
  FilteredThrust thrust_;
  ProjectedEquations equations_;
  Thetas regularised_;
  Thetas thetas_;
  // Of the last iteration.
  std::vector<Eigen::MatrixXd> filtering_losses_;
  std::vector<Eigen::MatrixXd> by_delay_;
  std::vector<ResidualWhitening> whitenings_;
  StackedSystem system_;
  Eigen::MatrixXd inverse_;  ///< of the system's A
  Eigen::Vector2d delays_s_ = Eigen::Vector2d::Zero();
};

}  // namespace

std::optional<WeakFit> EstimateWeakIv(const PreparedDataset& dataset,
                                      const RegressionOptions& regression,
                                      const std::array<std::vector<std::size_t>, 3>& columns,
                                      const WeakIvOptions& options) {
  const WeakProblem problem = BuildWeakForm(dataset, regression, options.form);
  const bool lagging = regression.structure == Structure::kFirstOrderDynamic;
  WeakIvIteration iteration(dataset, problem, columns, options, lagging);
  if (!iteration.IsOverdetermined()) return std::nullopt;
  Require(options.iterations >= 1, "at least one iteration");
  iteration.Start();
  const int rounds = lagging ? 2 * options.iterations : options.iterations;
  for (int round = 0; round < rounds; ++round) {
    if (!iteration.Iterate()) return std::nullopt;
  }
  return std::move(iteration).Fit();
}

}  // namespace telltale
