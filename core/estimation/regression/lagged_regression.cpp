#include "telltale/core/estimation/regression/lagged_regression.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <ceres/ceres.h>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/estimation/regression/triangular_factor.hpp"
#include "telltale/core/vessel/thruster_response.hpp"

namespace telltale {
namespace {

// Lags in sampling periods. Below the least a lag cannot be told from none, nor above the longest
// from a thrust that never arrives.
constexpr double kShortestLag = 1e-3;
constexpr double kLongestLag = 1e4;

// Initial thrust that has decayed to this share of itself is no longer worth a direction of its
// own.
constexpr double kForgotten = 1e-12;

/// The propeller regressors averaged over each row's interval, and how they change with the lag.
/// Each segment begins in its commanded thrust.
struct LaggedThrust {
  std::vector<ThrustRegressors> mean;
  std::vector<ThrustRegressors> slope;
};

LaggedThrust FollowThrust(const LaggedProblem& problem, const LagPerPeriod& lag) {
  LaggedThrust lagged{problem.commanded, std::vector<ThrustRegressors>(problem.commanded.size())};
  const auto follow = [&](auto part, std::size_t i, const RowRange& segment) {
    // Thrust lags its command by `behind`, which decays while the command is held.
    double behind = 0.0;
    double behind_slope = 0.0;
    for (std::size_t k = segment.begin; k < segment.end; ++k) {
      const double commanded = (problem.commanded[k].*part)[i];
      (lagged.mean[k].*part)[i] = commanded + lag.mean * behind;
      (lagged.slope[k].*part)[i] = lag.mean * behind_slope + lag.mean_slope * behind;
      if (k + 1 == segment.end) break;
      const double change = commanded - (problem.commanded[k + 1].*part)[i];
      behind_slope = lag.remaining * behind_slope + lag.remaining_slope * behind;
      behind = lag.remaining * behind + change;
    }
  };
  for (const RowRange& segment : problem.segments) {
    for (std::size_t i = 0; i < 4; ++i) {
      follow(&ThrustRegressors::surge, i, segment);
      follow(&ThrustRegressors::turning, i, segment);
    }
  }
  return lagged;
}

/// One answered equation at one lag, its unknown initial thrusts projected out: y = phi theta + e,
/// and slope, how the propeller columns of phi change with the lag.
struct Projected {
  Eigen::MatrixXd phi;
  Eigen::MatrixXd slope;
  Eigen::VectorXd y;
  double directions_out = 0.0;
};

/// Rows of the problem that lie in each segment of the dataset.
std::vector<RowRange> RowsOfSegments(const EquationProblem& equation,
                                     const std::vector<RowRange>& segments) {
  const auto& instants = equation.instants;
  const auto at = [&](std::size_t row) {
    return static_cast<std::size_t>(std::lower_bound(instants.begin(), instants.end(), row) -
                                    instants.begin());
  };
  std::vector<RowRange> rows;
  for (const RowRange& segment : segments) rows.push_back({at(segment.begin), at(segment.end)});
  return rows;
}

/// Takes alpha^m out of the rows of each segment: alpha is the share of a lag that remains after a
/// period, m counts rows from the segment's start.
void ProjectInitialThrust(const LaggedProblem& problem, const EquationProblem& equation,
                          const LagPerPeriod& lag, Projected& at) {
  if (lag.remaining < kForgotten) return;
  const auto rows_of = RowsOfSegments(equation, problem.segments);
  for (std::size_t s = 0; s < rows_of.size(); ++s) {
    const auto begin = static_cast<Eigen::Index>(rows_of[s].begin);
    // Beyond these rows the start is forgotten and the direction is zero.
    const auto remembered =
        static_cast<std::size_t>(std::log(kForgotten) / std::log(lag.remaining)) + 1;
    const std::size_t last = problem.segments[s].begin + remembered;
    Eigen::Index count = 0;
    while (count < static_cast<Eigen::Index>(rows_of[s].size()) &&
           equation.instants[static_cast<std::size_t>(begin + count)] < last) {
      ++count;
    }
    if (count == 0) continue;
    Eigen::VectorXd decay(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const std::size_t k = equation.instants[static_cast<std::size_t>(begin + i)];
      decay[i] = std::pow(lag.remaining, static_cast<double>(k - problem.segments[s].begin));
    }
    decay.normalize();
    const auto project = [&](auto rows) { rows -= decay * (decay.transpose() * rows).eval(); };
    project(at.phi.middleRows(begin, count));
    project(at.slope.middleRows(begin, count));
    project(at.y.segment(begin, count));
    at.directions_out += 1.0;
  }
}

Projected ProjectAt(const LaggedProblem& problem, const EquationProblem& equation,
                    const std::vector<std::size_t>& excited, const LaggedThrust& thrust,
                    const LagPerPeriod& lag) {
  const std::size_t body = BodyRegressors(equation.equation);
  const auto first_thrust = std::lower_bound(excited.begin(), excited.end(), body);
  const auto propellers = excited.end() - first_thrust;
  const auto bodies = first_thrust - excited.begin();
  Projected at;
  at.phi.resize(equation.phi.rows(), bodies + propellers);
  at.slope.resize(equation.phi.rows(), propellers);
  for (Eigen::Index j = 0; j < bodies; ++j) {
    at.phi.col(j) =
        equation.phi.col(static_cast<Eigen::Index>(excited[static_cast<std::size_t>(j)]));
  }
  for (Eigen::Index j = 0; j < propellers; ++j) {
    const std::size_t term = *(first_thrust + j) - body;
    for (Eigen::Index i = 0; i < at.phi.rows(); ++i) {
      const std::size_t k = equation.instants[static_cast<std::size_t>(i)];
      at.phi(i, bodies + j) = thrust.mean[k].Of(equation.equation)[term];
      at.slope(i, j) = thrust.slope[k].Of(equation.equation)[term];
    }
  }
  at.y = equation.y;
  ProjectInitialThrust(problem, equation, lag, at);
  return at;
}

/// One equation solved at one lag. Rows are rotated so that few remain: cost and its Kaufman
/// derivative keep their lengths and angles, which is all that a Gauss-Newton step looks at.
struct Solved {
  Eigen::VectorXd theta;
  Eigen::VectorXd residual;    ///< rotated
  Eigen::VectorXd derivative;  ///< of the residual by the lag, rotated alike
  double variance = 0.0;
  double degrees_of_freedom = 0.0;
};

Solved Solve(const Projected& at) {
  const Eigen::Index p = at.phi.cols();
  const Eigen::Index q = at.slope.cols();
  const Eigen::VectorXd norms =
      at.phi.colwise().norm().transpose().cwiseMax(std::numeric_limits<double>::min());
  Eigen::MatrixXd both(at.phi.rows(), p + q);
  both << at.phi * norms.cwiseInverse().asDiagonal(), at.slope;
  const TriangularFactor factor = Triangularise(both, at.y);

  Solved solved;
  const Eigen::MatrixXd corner = factor.R.topLeftCorner(p, p);
  const Eigen::VectorXd right = factor.z.head(p);
  const auto decomposition = corner.completeOrthogonalDecomposition();
  solved.theta = decomposition.solve(right).cwiseQuotient(norms);
  // What the first p rows leave (nothing, unless columns depend on each other), then the rest of
  // the triangle.
  const Eigen::VectorXd by_lag = factor.R.rightCols(q) * solved.theta.tail(q);
  const auto residual_of = [&](const Eigen::VectorXd& rows) {
    Eigen::VectorXd rest = rows;
    const Eigen::VectorXd head = rows.head(p);
    rest.head(p) -= corner * decomposition.solve(head);
    return rest;
  };
  solved.residual.resize(p + q + 1);
  solved.residual << residual_of(factor.z), factor.rho;
  solved.derivative.resize(p + q + 1);
  solved.derivative << -residual_of(by_lag), 0.0;
  solved.degrees_of_freedom = static_cast<double>(at.y.size() - p) - at.directions_out - 1.0;
  // Data made by the model itself leave nothing; a floor keeps the weights finite.
  const double floor = 1e-12 * at.y.norm();
  solved.variance =
      std::max(solved.residual.squaredNorm(), floor * floor) / solved.degrees_of_freedom;
  return solved;
}

/// The equations to answer, in order, and the columns of each that the data move.
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

std::vector<Projected> ProjectAll(const LaggedProblem& problem, const EstimatedEquations& estimated,
                                  double periods) {
  const LagPerPeriod lag = LagOver(periods);
  const LaggedThrust thrust = FollowThrust(problem, lag);
  std::vector<Projected> projected;
  for (std::size_t i = 0; i < estimated.which.size(); ++i) {
    projected.push_back(ProjectAt(problem, problem.at_once.equations[estimated.which[i]],
                                  estimated.excited[i], thrust, lag));
  }
  return projected;
}

std::vector<Solved> SolveAll(const LaggedProblem& problem, const EstimatedEquations& estimated,
                             double periods) {
  std::vector<Solved> solved;
  for (const Projected& at : ProjectAll(problem, estimated, periods)) solved.push_back(Solve(at));
  return solved;
}

/// What all equations leave, weighted, as a function of the lag in periods alone.
class LagCost : public ceres::CostFunction {
 public:
  LagCost(const LaggedProblem& problem, const EstimatedEquations& estimated,
          const std::vector<Solved>& start)
      : problem_(problem), estimated_(estimated) {
    Eigen::Index rows = 0;
    for (const Solved& equation : start) {
      weights_.push_back(1.0 / std::sqrt(equation.variance));
      rows += equation.residual.size();
    }
    set_num_residuals(static_cast<int>(rows));
    mutable_parameter_block_sizes()->push_back(1);
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const std::vector<Solved> solved = SolveAll(problem_, estimated_, parameters[0][0]);
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

/// No lag to speak of, then lags from a quarter of a period to 32 periods, each twice the one
/// before: the one that leaves least, by the sum over the equations of the logarithm of the
/// residual variance.
double BestGridLag(const LaggedProblem& problem, const EstimatedEquations& estimated) {
  double best = kShortestLag;
  double least = std::numeric_limits<double>::infinity();
  for (const double periods : {kShortestLag, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0}) {
    double misfit = 0.0;
    for (const Solved& equation : SolveAll(problem, estimated, periods)) {
      misfit += std::log(equation.variance);
    }
    if (misfit < least) {
      least = misfit;
      best = periods;
    }
  }
  return best;
}

/// One solve for the lag, each equation weighted by what it leaves at `start`.
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

/// Repeats the solve until the weights belong to the lag they lead to.
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

EquationEstimate WriteEstimate(const Excitation& excitation, const Solved& solved) {
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

WeightedRows ApplyWeights(const Projected& at, const EquationEstimate& estimate, double h) {
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

LaggedProblem BuildLagged(const PreparedDataset& dataset, const RegressionOptions& options) {
  RegressionOptions at_once = options;
  at_once.structure = Structure::kStaticQuadratic;
  LaggedProblem problem;
  problem.at_once = BuildRegression(dataset, at_once);
  problem.segments = dataset.segments;
  for (const PreparedRow& row : dataset.rows) {
    problem.commanded.push_back(
        ThrustOf(options.parameterization, options.dead_zone.Apply(row.delta)));
  }
  return problem;
}

double LagDeviance(const LaggedProblem& problem,
                   const std::array<std::optional<Excitation>, 3>& excitations,
                   const LaggedEstimate& estimate, double time_constant_s) {
  const EstimatedEquations estimated = EstimatedEquationsOf(excitations);
  const double periods = time_constant_s / problem.at_once.sampling_period_s;
  double deviance = 0.0;
  const std::vector<Solved> solved = SolveAll(problem, estimated, periods);
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
  const std::vector<Projected> projected = ProjectAll(problem, estimated, periods);
  for (std::size_t i = 0; i < projected.size(); ++i) {
    const std::size_t j = estimated.which[i];
    estimate.equations[j] = WriteEstimate(*excitations[j], Solve(projected[i]));
    rows.push_back(ApplyWeights(projected[i], *estimate.equations[j], h));
  }
  StackRows(problem, estimated, rows, estimate);
  return estimate;
}

}  // namespace telltale
