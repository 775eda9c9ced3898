#include "telltale/core/estimation/regression/lagged_regression.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <ceres/ceres.h>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/estimation/regression/variable_projection.hpp"

namespace telltale {
namespace {

// Lags in sampling periods. A shorter lag is indistinguishable from none, a longer one from a
// thrust that never arrives.
constexpr double kShortestLag = 1e-3;
constexpr double kLongestLag = 1e4;

/// The equations to estimate, in order, and the excited columns of each.
struct EstimatedEquations {
  std::vector<std::size_t> which;
  std::vector<std::vector<std::size_t>> excited;
};

EstimatedEquations EstimatedEquationsOf(
    const std::array<std::optional<Excitation>, 3>& excitations) {
  EstimatedEquations estimated;
  for (std::size_t j = 0; j < excitations.size(); ++j) {
    if (!excitations[j]) continue;
    estimated.which.push_back(j);
    estimated.excited.push_back(excitations[j]->excited);
  }
  return estimated;
}

std::vector<EquationAtLag> ProjectAll(const LaggedProblem& problem,
                                      const EstimatedEquations& estimated, double periods) {
  const LagPerPeriod lag = LagOver(periods);
  const LaggedThrust thrust = LagThrust(problem, lag);
  std::vector<EquationAtLag> projected;
  for (std::size_t i = 0; i < estimated.which.size(); ++i) {
    projected.push_back(ProjectAt(problem, problem.at_once.equations[estimated.which[i]],
                                  estimated.excited[i], thrust, lag));
  }
  return projected;
}

std::vector<SolutionAtLag> SolveAll(const LaggedProblem& problem,
                                    const EstimatedEquations& estimated, double periods) {
  std::vector<SolutionAtLag> solved;
  for (const EquationAtLag& at : ProjectAll(problem, estimated, periods))
    solved.push_back(SolveAt(at));
  return solved;
}

/// The weighted residuals of all equations as a function of the lag in sampling periods.
class LagCost : public ceres::CostFunction {
 public:
  LagCost(const LaggedProblem& problem, const EstimatedEquations& estimated,
          const std::vector<SolutionAtLag>& start)
      : problem_(problem), estimated_(estimated) {
    Eigen::Index rows = 0;
    for (const SolutionAtLag& equation : start) {
      weights_.push_back(1.0 / std::sqrt(equation.variance));
      rows += equation.residual.size();
    }
    set_num_residuals(static_cast<int>(rows));
    mutable_parameter_block_sizes()->push_back(1);
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const std::vector<SolutionAtLag> solved = SolveAll(problem_, estimated_, parameters[0][0]);
    Eigen::Index first = 0;
    for (std::size_t i = 0; i < solved.size(); ++i) {
      const Eigen::Index rows = solved[i].residual.size();
      Eigen::Map<Eigen::VectorXd>(residuals + first, rows) = weights_[i] * solved[i].residual;
      if (jacobians != nullptr && jacobians[0] != nullptr) {
        Eigen::Map<Eigen::VectorXd>(jacobians[0] + first, rows) =
            weights_[i] * solved[i].derivative;
      }
      first += rows;
    }
    return true;
  }

 private:
  const LaggedProblem& problem_;
  const EstimatedEquations& estimated_;
  std::vector<double> weights_;
};

/// The best of a grid: a negligible lag, then lags from a quarter of a period to 32 periods, each
/// twice the one before. The criterion is the sum over the equations of the logarithm of the
/// residual variance.
double BestGridLag(const LaggedProblem& problem, const EstimatedEquations& estimated) {
  double best = kShortestLag;
  double least = std::numeric_limits<double>::infinity();
  for (const double periods : {kShortestLag, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0}) {
    double misfit = 0.0;
    for (const SolutionAtLag& equation : SolveAll(problem, estimated, periods)) {
      misfit += std::log(equation.variance);
    }
    if (misfit < least) {
      least = misfit;
      best = periods;
    }
  }
  return best;
}

/// One solve for the lag, each equation weighted by its residual variance at `start`.
double SolveWeighted(const LaggedProblem& problem, const EstimatedEquations& estimated,
                     double start) {
  double periods = start;
  ceres::Problem joint;  // owns its cost function
  joint.AddResidualBlock(new LagCost(problem, estimated, SolveAll(problem, estimated, start)),
                         nullptr, &periods);
  joint.SetParameterLowerBound(&periods, 0, kShortestLag);
  joint.SetParameterUpperBound(&periods, 0, kLongestLag);
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 100;
  options.function_tolerance = 1e-14;
  options.gradient_tolerance = 1e-14;
  options.parameter_tolerance = 1e-12;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &joint, &summary);
  return periods;
}

/// Repeats the solve until the weights belong to the lag that they give.
double SolveLag(const LaggedProblem& problem, const EstimatedEquations& estimated) {
  constexpr int kMostRounds = 5;
  constexpr double kSettled = 1e-7;
  double periods = BestGridLag(problem, estimated);
  for (int round = 0; round < kMostRounds; ++round) {
    const double next = SolveWeighted(problem, estimated, periods);
    const bool settled = std::abs(next - periods) < kSettled * periods;
    periods = next;
    if (settled) break;
  }
  return periods;
}

EquationEstimate WriteEstimate(const Excitation& excitation, const SolutionAtLag& solved) {
  EquationEstimate estimate;
  estimate.equation = excitation.equation;
  estimate.columns = excitation.excited;
  estimate.theta = solved.theta;
  estimate.estimable.assign(excitation.excited.size(), true);
  estimate.degrees_of_freedom = solved.degrees_of_freedom;
  estimate.residual_variance = solved.variance;
  return estimate;
}

/// One equation's weighted rows, before they are grouped by segment.
struct WeightedRows {
  Eigen::VectorXd by_time_constant;
  Eigen::MatrixXd phi;
  Eigen::VectorXd residual;
};

WeightedRows ApplyWeights(const EquationAtLag& at, const EquationEstimate& estimate, double h) {
  const double weight = 1.0 / std::sqrt(estimate.residual_variance);
  return {weight / h * (at.slope * estimate.theta.tail(at.slope.cols())), weight * at.phi,
          weight * (at.y - at.phi * estimate.theta)};
}

/// Fills the joint Jacobian and residual, rows grouped by segment.
void StackRows(const LaggedProblem& problem, const EstimatedEquations& estimated,
               const std::vector<WeightedRows>& equations, LaggedEstimate& estimate) {
  Eigen::Index rows = 0;
  Eigen::Index columns = 1;
  for (const WeightedRows& equation : equations) {
    rows += equation.phi.rows();
    columns += equation.phi.cols();
  }
  estimate.jacobian = Eigen::MatrixXd::Zero(rows, columns);
  estimate.residual.resize(rows);
  Eigen::Index row = 0;
  for (std::size_t s = 0; s < problem.at_once.equations[0].clusters.size(); ++s) {
    const auto first_row = static_cast<std::size_t>(row);
    Eigen::Index column = 1;
    for (std::size_t i = 0; i < equations.size(); ++i) {
      const EquationProblem& equation = problem.at_once.equations[estimated.which[i]];
      const RowRange& cluster = equation.clusters[s];
      const auto instants = equation.instants.begin();
      const auto begin = static_cast<Eigen::Index>(cluster.begin);
      const auto count = static_cast<Eigen::Index>(cluster.size());
      const Eigen::Index p = equations[i].phi.cols();
      estimate.jacobian.block(row, 0, count, 1) =
          equations[i].by_time_constant.segment(begin, count);
      estimate.jacobian.block(row, column, count, p) = equations[i].phi.middleRows(begin, count);
      estimate.residual.segment(row, count) = equations[i].residual.segment(begin, count);
      estimate.instants.insert(estimate.instants.end(),
                               instants + static_cast<std::ptrdiff_t>(cluster.begin),
                               instants + static_cast<std::ptrdiff_t>(cluster.end));
      row += count;
      column += p;
    }
    estimate.clusters.push_back({first_row, static_cast<std::size_t>(row)});
  }
}

}  // namespace

double LagDeviance(const LaggedProblem& problem,
                   const std::array<std::optional<Excitation>, 3>& excitations,
                   const LaggedEstimate& estimate, double time_constant_s) {
  const EstimatedEquations estimated = EstimatedEquationsOf(excitations);
  const double periods = time_constant_s / problem.at_once.sampling_period_s;
  double deviance = 0.0;
  const std::vector<SolutionAtLag> solved = SolveAll(problem, estimated, periods);
  for (std::size_t i = 0; i < solved.size(); ++i) {
    const double least = estimate.equations[estimated.which[i]]->residual_variance;
    deviance += solved[i].degrees_of_freedom * std::log(solved[i].variance / least);
  }
  return deviance;
}

LagLimits LimitsOfLag(const LaggedProblem& problem) {
  const double h = problem.at_once.sampling_period_s;
  return {kShortestLag * h, kLongestLag * h};
}

LaggedEstimate EstimateLagged(const LaggedProblem& problem,
                              const std::array<std::optional<Excitation>, 3>& excitations) {
  const EstimatedEquations estimated = EstimatedEquationsOf(excitations);
  Require(!estimated.which.empty(), "at least one answered equation");

  LaggedEstimate estimate;
  const double h = problem.at_once.sampling_period_s;
  const double periods = SolveLag(problem, estimated);
  estimate.time_constant_s = periods * h;
  estimate.lag_at_lower_bound = periods < 1.001 * kShortestLag;
  std::vector<WeightedRows> rows;
  const std::vector<EquationAtLag> projected = ProjectAll(problem, estimated, periods);
  for (std::size_t i = 0; i < projected.size(); ++i) {
    const std::size_t j = estimated.which[i];
    estimate.equations[j] = WriteEstimate(*excitations[j], SolveAt(projected[i]));
    rows.push_back(ApplyWeights(projected[i], *estimate.equations[j], h));
  }
  StackRows(problem, estimated, rows, estimate);
  return estimate;
}

}  // namespace telltale
