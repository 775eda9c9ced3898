#include "estimation/lagged_regression.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/QR>
#include <ceres/ceres.h>

#include "contract.hpp"
#include "estimation/triangular_factor.hpp"

namespace telltale {
namespace {

// alpha stays this far inside (0, 1): at 5 Hz that is lags from 0.02 s to half an hour.
constexpr double kLeastAlpha = 1e-4;

// Initial thrust that has decayed to this share of itself is no longer worth a direction of its own.
constexpr double kForgotten = 1e-6;

LaggedEquation BuildLaggedEquation(const PreparedDataset& dataset, Equation equation,
                                   const RegressionOptions& options) {
  LaggedEquation lagged;
  lagged.equation = equation;
  lagged.regressors = Regressors(equation, options.parameterization);
  for (const RowRange& segment : dataset.segments) {
    const std::size_t first = lagged.instants.size();
    const RowRange range = InstantsAfter(segment, dataset.stretches);
    for (std::size_t k = range.begin; k < range.end; ++k) {
      if (Enters(dataset.rows[k - 1].region, equation, options)) lagged.instants.push_back(k);
    }
    lagged.clusters.push_back({first, lagged.instants.size()});
  }
  for (const RowRange& stretch : dataset.stretches) {
    const auto at = [&](std::size_t row) {
      return static_cast<std::size_t>(
          std::lower_bound(lagged.instants.begin(), lagged.instants.end(), row) -
          lagged.instants.begin());
    };
    lagged.stretches.push_back({at(stretch.begin), at(stretch.end)});
  }

  const auto rows = static_cast<Eigen::Index>(lagged.instants.size());
  const std::size_t body = BodyRegressors(equation);
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> phi(
      rows, static_cast<Eigen::Index>(body));
  lagged.y.resize(rows);
  lagged.nu.resize(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const std::size_t k = lagged.instants[static_cast<std::size_t>(i)];
    FillBody(equation, dataset.rows[k].nu, {phi.row(i).data(), body});
    lagged.nu[i] = ComponentOf(dataset.rows[k].nu, equation);
    lagged.y[i] = (ComponentOf(dataset.rows[k + 1].nu, equation) - lagged.nu[i]) /
                  dataset.sampling_period_s;
  }
  lagged.body = phi;
  return lagged;
}

/// The propeller regressors after the lag, and how they change with alpha, at every row of the dataset:
/// T(k+1) = alpha T(k) + (1 - alpha) commanded(k), each stretch begun in its commanded thrust.
struct LaggedThrust {
  std::vector<ThrustRegressors> value;
  std::vector<ThrustRegressors> slope;
};

LaggedThrust FollowThrust(const LaggedProblem& problem, double alpha) {
  LaggedThrust lagged{problem.commanded, std::vector<ThrustRegressors>(problem.commanded.size())};
  const auto follow = [&](auto part) {
    for (const RowRange& stretch : problem.stretches) {
      for (std::size_t k = stretch.begin; k + 1 < stretch.end; ++k) {
        for (std::size_t i = 0; i < 4; ++i) {
          const double now = (lagged.value[k].*part)[i];
          const double commanded = (problem.commanded[k].*part)[i];
          (lagged.value[k + 1].*part)[i] = alpha * now + (1.0 - alpha) * commanded;
          (lagged.slope[k + 1].*part)[i] = now - commanded + alpha * (lagged.slope[k].*part)[i];
        }
      }
    }
  };
  follow(&ThrustRegressors::surge);
  follow(&ThrustRegressors::turning);
  return lagged;
}

/// One answered equation at one alpha, its unknown initial thrusts projected out: y = phi theta + e, and
/// the change of phi theta with alpha.
struct Projected {
  Eigen::MatrixXd phi;
  Eigen::VectorXd y;
  Eigen::MatrixXd thrust_slope;  ///< d phi / d alpha of the propeller columns
  Eigen::Index body = 0;
  double projected_directions = 0.0;
};

/// Takes alpha^m out of the rows of each stretch, where m counts rows from its start.
void ProjectInitialThrust(const LaggedProblem& problem, const LaggedEquation& lagged, double alpha,
                          Projected& at) {
  for (std::size_t s = 0; s < lagged.stretches.size(); ++s) {
    const auto begin = static_cast<Eigen::Index>(lagged.stretches[s].begin);
    const auto count = static_cast<Eigen::Index>(lagged.stretches[s].size());
    if (count == 0) continue;
    Eigen::VectorXd decay(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const std::size_t k = lagged.instants[static_cast<std::size_t>(begin + i)];
      decay[i] = std::pow(alpha, static_cast<double>(k - problem.stretches[s].begin));
    }
    const double norm = decay.norm();
    // Rows that begin long after the stretch does no longer remember how it began.
    if (norm < kForgotten) continue;
    decay /= norm;
    const auto project = [&](auto rows) { rows -= decay * (decay.transpose() * rows).eval(); };
    project(at.phi.middleRows(begin, count));
    project(at.thrust_slope.middleRows(begin, count));
    project(at.y.segment(begin, count));
    at.projected_directions += 1.0;
  }
}

Eigen::MatrixXd Select(const Eigen::MatrixXd& all, const std::vector<Eigen::Index>& columns) {
  Eigen::MatrixXd selected(all.rows(), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t j = 0; j < columns.size(); ++j) {
    selected.col(static_cast<Eigen::Index>(j)) = all.col(columns[j]);
  }
  return selected;
}

/// Splits excited columns into those of the body and those of the propellers, the latter counted from 0.
struct ExcitedParts {
  std::vector<Eigen::Index> body;
  std::vector<Eigen::Index> propeller;
};

ExcitedParts Split(const std::vector<std::size_t>& excited, Equation equation) {
  ExcitedParts parts;
  const std::size_t body = BodyRegressors(equation);
  for (const std::size_t column : excited) {
    if (column < body) {
      parts.body.push_back(static_cast<Eigen::Index>(column));
    } else {
      parts.propeller.push_back(static_cast<Eigen::Index>(column - body));
    }
  }
  return parts;
}

Projected ProjectAt(const LaggedProblem& problem, const LaggedEquation& lagged,
                    const ExcitedParts& parts, const LaggedThrust& thrust, double alpha) {
  Projected at;
  const auto rows = static_cast<Eigen::Index>(lagged.instants.size());
  const auto propeller = static_cast<Eigen::Index>(parts.propeller.size());
  at.body = static_cast<Eigen::Index>(parts.body.size());
  at.phi.resize(rows, at.body + propeller);
  at.phi.leftCols(at.body) = Select(lagged.body, parts.body);
  at.thrust_slope.resize(rows, propeller);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const std::size_t k = lagged.instants[static_cast<std::size_t>(i)];
    for (Eigen::Index j = 0; j < propeller; ++j) {
      const auto term = static_cast<std::size_t>(parts.propeller[static_cast<std::size_t>(j)]);
      at.phi(i, at.body + j) = thrust.value[k].Of(lagged.equation)[term];
      at.thrust_slope(i, j) = thrust.slope[k].Of(lagged.equation)[term];
    }
  }
  at.y = lagged.y;
  ProjectInitialThrust(problem, lagged, alpha, at);
  return at;
}

/// What the joint solve works on: the answered equations, in order.
struct Answered {
  std::vector<std::size_t> which;
  std::vector<ExcitedParts> parts;
};

/// One equation solved at one alpha. by_alpha is how phi theta changes with alpha at that theta.
struct Solved {
  Projected at;
  Eigen::VectorXd theta;
  Eigen::VectorXd residual;
  Eigen::VectorXd by_alpha;
  double variance = 0.0;
  double degrees_of_freedom = 0.0;
};

Eigen::VectorXd LeastSquares(const Eigen::MatrixXd& phi, const Eigen::VectorXd& y) {
  const Eigen::VectorXd norms =
      phi.colwise().norm().transpose().cwiseMax(std::numeric_limits<double>::min());
  const TriangularFactor factor = Triangularise(phi * norms.cwiseInverse().asDiagonal(), y);
  return factor.R.completeOrthogonalDecomposition().solve(factor.z).cwiseQuotient(norms);
}

Solved SolveEquation(const LaggedProblem& problem, const Answered& answered, std::size_t i,
                     const LaggedThrust& thrust, double alpha) {
  Solved solved;
  solved.at = ProjectAt(problem, problem.equations[answered.which[i]], answered.parts[i], thrust,
                        alpha);
  solved.theta = LeastSquares(solved.at.phi, solved.at.y);
  solved.residual = solved.at.y - solved.at.phi * solved.theta;
  solved.by_alpha =
      solved.at.thrust_slope * solved.theta.tail(solved.at.thrust_slope.cols());
  solved.degrees_of_freedom = static_cast<double>(solved.at.y.size() - solved.theta.size()) -
                              solved.at.projected_directions - 1.0;
  // Data made by the model itself leave nothing; a floor keeps the weights finite.
  const double floor = 1e-12 * solved.at.y.norm();
  solved.variance = std::max(solved.residual.squaredNorm() / solved.degrees_of_freedom,
                             floor * floor);
  return solved;
}

std::vector<Solved> SolveAll(const LaggedProblem& problem, const Answered& answered, double alpha) {
  const LaggedThrust thrust = FollowThrust(problem, alpha);
  std::vector<Solved> solved;
  for (std::size_t i = 0; i < answered.which.size(); ++i) {
    solved.push_back(SolveEquation(problem, answered, i, thrust, alpha));
  }
  return solved;
}

/// The residual of all equations as a function of alpha alone.
class LagCost : public ceres::CostFunction {
 public:
  LagCost(const LaggedProblem& problem, const Answered& answered, std::vector<double> weights)
      : problem_(problem), answered_(answered), weights_(std::move(weights)) {
    Eigen::Index rows = 0;
    for (const std::size_t j : answered.which) rows += problem.equations[j].y.size();
    set_num_residuals(static_cast<int>(rows));
    mutable_parameter_block_sizes()->push_back(1);
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const std::vector<Solved> solved = SolveAll(problem_, answered_, parameters[0][0]);
    Eigen::Index first = 0;
    for (std::size_t i = 0; i < solved.size(); ++i) {
      const Solved& equation = solved[i];
      const Eigen::Index rows = equation.residual.size();
      Eigen::Map<Eigen::VectorXd>(residuals + first, rows) = weights_[i] * equation.residual;
      if (jacobians != nullptr && jacobians[0] != nullptr) {
        // Kaufman: the change of phi theta with alpha, less what theta would absorb of it.
        Eigen::Map<Eigen::VectorXd>(jacobians[0] + first, rows) =
            -weights_[i] * (equation.by_alpha -
                            equation.at.phi * LeastSquares(equation.at.phi, equation.by_alpha));
      }
      first += rows;
    }
    return true;
  }

 private:
  const LaggedProblem& problem_;
  const Answered& answered_;
  std::vector<double> weights_;
};

std::vector<double> WeightsAt(const LaggedProblem& problem, const Answered& answered,
                              double alpha) {
  std::vector<double> weights;
  for (const Solved& equation : SolveAll(problem, answered, alpha)) {
    weights.push_back(1.0 / std::sqrt(equation.variance));
  }
  return weights;
}

/// Lags from a quarter of a period to 32 periods, each twice the one before; the one that leaves least,
/// by the sum over the equations of the logarithm of the residual variance.
double BestGridAlpha(const LaggedProblem& problem, const Answered& answered) {
  double best = 0.5;
  double least = std::numeric_limits<double>::infinity();
  for (double periods = 0.25; periods <= 32.0; periods *= 2.0) {
    const double alpha = std::exp(-1.0 / periods);
    double misfit = 0.0;
    for (const Solved& equation : SolveAll(problem, answered, alpha)) {
      misfit += std::log(equation.variance);
    }
    if (misfit < least) {
      least = misfit;
      best = alpha;
    }
  }
  return best;
}

/// One solve for alpha, each equation weighted by what it leaves at `start_alpha`.
double SolveWeighted(const LaggedProblem& problem, const Answered& answered, double start_alpha) {
  double alpha = start_alpha;
  ceres::Problem joint;  // owns its cost function
  joint.AddResidualBlock(
      new LagCost(problem, answered, WeightsAt(problem, answered, start_alpha)), nullptr, &alpha);
  joint.SetParameterLowerBound(&alpha, 0, kLeastAlpha);
  joint.SetParameterUpperBound(&alpha, 0, 1.0 - kLeastAlpha);
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 100;
  options.function_tolerance = 1e-14;
  options.gradient_tolerance = 1e-14;
  options.parameter_tolerance = 1e-12;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &joint, &summary);
  return alpha;
}

/// Repeats the solve until the weights belong to the alpha they lead to.
double SolveAlpha(const LaggedProblem& problem, const Answered& answered) {
  constexpr int kMostRounds = 5;
  constexpr double kSettled = 1e-9;
  double alpha = BestGridAlpha(problem, answered);
  for (int round = 0; round < kMostRounds; ++round) {
    const double next = SolveWeighted(problem, answered, alpha);
    const bool settled = std::abs(next - alpha) < kSettled;
    alpha = next;
    if (settled) break;
  }
  return alpha;
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

/// Fills the joint Jacobian and residual, rows grouped by segment.
void StackRows(const LaggedProblem& problem, const Answered& answered,
               const std::vector<Solved>& solved, LaggedEstimate& estimate) {
  Eigen::Index rows = 0;
  Eigen::Index columns = 1;
  for (const Solved& equation : solved) {
    rows += equation.residual.size();
    columns += equation.theta.size();
  }
  estimate.jacobian = Eigen::MatrixXd::Zero(rows, columns);
  estimate.residual.resize(rows);
  Eigen::Index row = 0;
  for (std::size_t s = 0; s < problem.equations[0].clusters.size(); ++s) {
    const auto first_row = static_cast<std::size_t>(row);
    Eigen::Index column = 1;
    for (std::size_t i = 0; i < solved.size(); ++i) {
      const RowRange& cluster = problem.equations[answered.which[i]].clusters[s];
      const auto begin = static_cast<Eigen::Index>(cluster.begin);
      const auto count = static_cast<Eigen::Index>(cluster.size());
      const double weight = 1.0 / std::sqrt(solved[i].variance);
      const Eigen::Index p = solved[i].theta.size();
      estimate.jacobian.block(row, 0, count, 1) =
          weight * solved[i].by_alpha.segment(begin, count);
      estimate.jacobian.block(row, column, count, p) =
          weight * solved[i].at.phi.middleRows(begin, count);
      estimate.residual.segment(row, count) = weight * solved[i].residual.segment(begin, count);
      row += count;
      column += p;
    }
    estimate.clusters.push_back({first_row, static_cast<std::size_t>(row)});
  }
}

}  // namespace

EquationProblem LaggedProblem::WithoutLag(Equation equation) const {
  const LaggedEquation& lagged = equations[IndexOf(equation)];
  const auto rows = static_cast<Eigen::Index>(lagged.instants.size());
  const Eigen::Index body = lagged.body.cols();
  EquationProblem problem;
  problem.equation = equation;
  problem.regressors = lagged.regressors;
  problem.phi.resize(rows, static_cast<Eigen::Index>(lagged.regressors.size()));
  problem.phi.leftCols(body) = lagged.body;
  for (Eigen::Index i = 0; i < rows; ++i) {
    const std::size_t k = lagged.instants[static_cast<std::size_t>(i)];
    for (Eigen::Index j = body; j < problem.phi.cols(); ++j) {
      problem.phi(i, j) = commanded[k - 1].Of(equation)[static_cast<std::size_t>(j - body)];
    }
  }
  problem.y = lagged.y;
  problem.nu = lagged.nu;
  problem.clusters = lagged.clusters;
  return problem;
}

LaggedProblem BuildLagged(const PreparedDataset& dataset, const RegressionOptions& options) {
  Require(dataset.sampling_period_s > 0.0, "a positive sampling period");
  LaggedProblem problem;
  problem.parameterization = options.parameterization;
  problem.sampling_period_s = dataset.sampling_period_s;
  problem.stretches = dataset.stretches;
  for (const PreparedRow& row : dataset.rows) {
    problem.commanded.push_back(
        ThrustOf(options.parameterization, options.dead_zone.Apply(row.delta)));
  }
  for (const Equation equation : kEquations) {
    problem.equations[IndexOf(equation)] = BuildLaggedEquation(dataset, equation, options);
  }
  return problem;
}

LaggedEstimate EstimateLagged(const LaggedProblem& problem,
                              const std::array<std::optional<Excitation>, 3>& excitations) {
  Answered answered;
  for (std::size_t j = 0; j < excitations.size(); ++j) {
    if (!excitations[j]) continue;
    answered.which.push_back(j);
    answered.parts.push_back(Split(excitations[j]->excited, problem.equations[j].equation));
  }
  Require(!answered.which.empty(), "at least one answered equation");

  LaggedEstimate estimate;
  estimate.alpha = SolveAlpha(problem, answered);
  estimate.time_constant_s = -problem.sampling_period_s / std::log(estimate.alpha);
  const std::vector<Solved> solved = SolveAll(problem, answered, estimate.alpha);
  for (std::size_t i = 0; i < solved.size(); ++i) {
    const std::size_t j = answered.which[i];
    estimate.equations[j] = WriteEstimate(*excitations[j], solved[i]);
  }
  StackRows(problem, answered, solved, estimate);
  return estimate;
}

}  // namespace telltale
