#include "telltale/core/estimation/weak_form/weak_iv.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

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

std::vector<Eigen::MatrixXd> InstrumentsOf(const ProjectedEquations& equations,
                                           const std::array<PredictedSupports, 3>& predicted) {
  std::vector<Eigen::MatrixXd> Z;
  for (const ProjectedEquation& equation : equations) Z.push_back(predicted[equation.index].Z);
  return Z;
}

/// The regressors as their own instruments: least squares.
std::vector<Eigen::MatrixXd> OwnInstruments(const ProjectedEquations& equations) {
  std::vector<Eigen::MatrixXd> own;
  for (const ProjectedEquation& equation : equations) own.push_back(equation.G);
  return own;
}

/// A whitening of each equation's residuals. It takes half of their variance for white, since their
/// whole autocorrelation suits only a boat that moves exactly as the model says. The fewer supports
/// there are for each coefficient, the less their autocorrelation counts.
std::vector<ResidualWhitening> WhiteningsOf(const WeakProblem& problem,
                                            const ProjectedEquations& equations,
                                            const Thetas& thetas) {
  constexpr Eigen::Index kOrder = 10;
  constexpr double kSupportsPerCoefficient = 10.0;
  std::vector<ResidualWhitening> whitenings;
  for (std::size_t i = 0; i < equations.size(); ++i) {
    const auto& [index, columns, G, b] = equations[i];
    const auto runs = RunsOf(problem.supports[index].first_rows, problem.phi.stride);
    Eigen::VectorXd shown = DefiniteAutocovariance(runs, b - G * thetas[i], kSupportResidualLags);
    const double few =
        kSupportsPerCoefficient * static_cast<double>(G.cols()) / static_cast<double>(G.rows());
    shown.tail(shown.size() - 1) /= 2.0 + few;
    whitenings.emplace_back(runs, shown.head(kOrder + 1));
  }
  return whitenings;
}

ProjectedEquations Whitened(const std::vector<ResidualWhitening>& whitenings,
                            const ProjectedEquations& equations) {
  ProjectedEquations white;
  for (std::size_t i = 0; i < equations.size(); ++i) {
    const auto& [index, columns, G, b] = equations[i];
    white.push_back({index, columns, whitenings[i].Whiten(G), whitenings[i].Whiten(b)});
  }
  return white;
}

std::vector<Eigen::MatrixXd> Whitened(const std::vector<ResidualWhitening>& whitenings,
                                      const std::vector<Eigen::MatrixXd>& sides) {
  std::vector<Eigen::MatrixXd> white;
  for (std::size_t i = 0; i < sides.size(); ++i) white.push_back(whitenings[i].Whiten(sides[i]));
  return white;
}

/// One over each equation's residual variance.
std::vector<double> ResidualWeights(const ProjectedEquations& equations, const Thetas& thetas) {
  std::vector<double> weights;
  for (std::size_t i = 0; i < equations.size(); ++i) {
    const Eigen::VectorXd e = ResidualOf(equations[i], thetas[i]);
    weights.push_back(static_cast<double>(e.size()) / std::max(e.squaredNorm(), kLeastSquares));
  }
  return weights;
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
    regularised_ = SolveRegularised(equations_, OwnInstruments(equations_), options_.ridge);
    thetas_ = regularised_;
  }

  /// One iteration; false when the instruments do not determine every unknown.
  bool Iterate() {
    LeaveLastRound();
    const auto predicted = instruments_.Predict(
        ModelWith(problem_, equations_, regularised_),
        ConstantDisturbancesWith(problem_, equations_, regularised_), columns_, thrust_);
    completed_ = WithFilteringLoss(equations_, predicted);
    by_delay_ = options_.delays ? ByDelay(equations_, predicted) : std::vector<Eigen::MatrixXd>();
    std::vector<Eigen::MatrixXd> by_lag;
    if (time_constant_s_)
      by_lag = LagDerivatives(dataset_, problem_, equations_, thetas_, *time_constant_s_);
    whitenings_ = WhiteningsOf(problem_, completed_, thetas_);
    const ProjectedEquations white = Whitened(whitenings_, completed_);
    const auto white_Z = Whitened(whitenings_, InstrumentsOf(equations_, predicted));
    system_ = StackEquations(white, white_Z,
                             {Whitened(whitenings_, by_lag), Whitened(whitenings_, by_delay_)},
                             ResidualWeights(white, thetas_));
    if (options_.delays) {
      system_.A.diagonal().tail<kDelays>().array() += 1.0 / (kDelayPriorS * kDelayPriorS);
    }
    auto inverse = InvertScaled(system_.A);
    if (!inverse) return false;
    inverse_ = *std::move(inverse);
    const Eigen::VectorXd solution = inverse_ * system_.c;
    UnstackThetas(solution, time_constant_s_ ? 1 : 0, thetas_);
    if (options_.delays) delays_s_ = solution.tail<kDelays>();
    regularised_ = SolveRegularised(white, white_Z, options_.ridge);
    if (time_constant_s_) {
      ChangeTimeConstant(solution[0]);
      completed_ = WithFilteringLoss(equations_, predicted);
    }
    return true;
  }

  /// The fit after the last iteration.
  WeakFit Fit() const {
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
    for (std::size_t i = 0; i < completed_.size(); ++i) {
      const std::size_t index = completed_[i].index;
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
    completed_.clear();
    by_delay_.clear();
    system_ = {};
  }

  static std::vector<Eigen::MatrixXd> ByDelay(const ProjectedEquations& equations,
                                              const std::array<PredictedSupports, 3>& predicted) {
    std::vector<Eigen::MatrixXd> by_delay;
    for (const ProjectedEquation& equation : equations)
      by_delay.push_back(predicted[equation.index].by_delay);
    return by_delay;
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
    Eigen::VectorXd residual = ResidualOf(completed_[i], thetas_[i]);
    if (options_.delays) residual -= by_delay_[i] * delays_s_;
    return {completed_[i].columns,
            thetas_[i],
            regularised_[i],
            completed_[i].G,
            whitenings_[i].WhitenBack(Z.middleCols(time_constant_s_ ? 1 : 0, thetas_[i].size())),
            residual};
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
  ProjectedEquations completed_;
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
  return iteration.Fit();
}

}  // namespace telltale
