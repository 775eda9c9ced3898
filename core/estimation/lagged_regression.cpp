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

LaggedEquation BuildLaggedEquation(const PreparedDataset& dataset, Equation equation,
                                   const RegressionOptions& options) {
  LaggedEquation lagged;
  lagged.equation = equation;
  lagged.regressors = Regressors(equation, options.parameterization);
  std::vector<std::size_t> instants;
  for (const RowRange& segment : dataset.segments) {
    const std::size_t first = instants.size();
    const RowRange range = InstantsAfter(segment, dataset.stretches);
    for (std::size_t k = range.begin; k < range.end; ++k) {
      if (Enters(dataset.rows[k - 1].region, equation, options)) instants.push_back(k);
    }
    lagged.clusters.push_back({first, instants.size()});
  }

  const auto rows = static_cast<Eigen::Index>(instants.size());
  const std::size_t body = BodyRegressors(equation);
  const std::size_t propeller = lagged.regressors.size() - body;
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  RowMajor now(rows, body);
  RowMajor before(rows, body);
  lagged.thrust.resize(rows, static_cast<Eigen::Index>(propeller));
  lagged.step_now.resize(rows);
  lagged.step_before.resize(rows);
  lagged.nu.resize(rows);
  const double h = dataset.sampling_period_s;
  for (Eigen::Index i = 0; i < rows; ++i) {
    const std::size_t k = instants[static_cast<std::size_t>(i)];
    const PreparedRow& last = dataset.rows[k - 1];
    const PreparedRow& row = dataset.rows[k];
    FillBody(equation, row.nu, {now.row(i).data(), body});
    FillBody(equation, last.nu, {before.row(i).data(), body});
    const ThrustRegressors thrust =
        ThrustOf(options.parameterization, options.dead_zone.Apply(last.delta));
    for (std::size_t j = 0; j < propeller; ++j) {
      lagged.thrust(i, static_cast<Eigen::Index>(j)) = thrust.Of(equation)[j];
    }
    const double here = ComponentOf(row.nu, equation);
    lagged.nu[i] = here;
    lagged.step_now[i] = (ComponentOf(dataset.rows[k + 1].nu, equation) - here) / h;
    lagged.step_before[i] = (here - ComponentOf(last.nu, equation)) / h;
  }
  lagged.now = now;
  lagged.before = before;
  return lagged;
}

/// One equation's rows reduced to a triangle, of the excited columns alone, in the column order
/// [step_now step_before now before thrust]. Residuals are triangle * Weights(alpha, theta).
struct Compressed {
  Eigen::MatrixXd triangle;
  Eigen::Index body = 0;
  Eigen::Index propeller = 0;
  Eigen::Index rows = 0;

  Eigen::Index Coefficients() const { return body + propeller; }

  Eigen::VectorXd Weights(double alpha, const Eigen::VectorXd& theta) const {
    Eigen::VectorXd weights(2 + 2 * body + propeller);
    weights << 1.0, -alpha, -theta.head(body), alpha * theta.head(body),
        -(1.0 - alpha) * theta.tail(propeller);
    return weights;
  }
  Eigen::VectorXd WeightsByAlpha(const Eigen::VectorXd& theta) const {
    Eigen::VectorXd weights = Eigen::VectorXd::Zero(2 + 2 * body + propeller);
    weights[1] = -1.0;
    weights.segment(2 + body, body) = theta.head(body);
    weights.tail(propeller) = theta.tail(propeller);
    return weights;
  }
  Eigen::MatrixXd ByTheta(double alpha) const {
    Eigen::MatrixXd jacobian(triangle.rows(), Coefficients());
    jacobian << -(triangle.middleCols(2, body) - alpha * triangle.middleCols(2 + body, body)),
        -(1.0 - alpha) * triangle.rightCols(propeller);
    return jacobian;
  }
};

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

Compressed Compress(const LaggedEquation& lagged, const ExcitedParts& parts) {
  Compressed compressed;
  compressed.body = static_cast<Eigen::Index>(parts.body.size());
  compressed.propeller = static_cast<Eigen::Index>(parts.propeller.size());
  compressed.rows = lagged.step_now.size();
  Eigen::MatrixXd stacked(compressed.rows, 1 + 2 * compressed.body + compressed.propeller);
  stacked << lagged.step_before, Select(lagged.now, parts.body), Select(lagged.before, parts.body),
      Select(lagged.thrust, parts.propeller);
  const TriangularFactor factor = Triangularise(stacked, lagged.step_now);
  const Eigen::Index width = stacked.cols();
  compressed.triangle = Eigen::MatrixXd::Zero(width + 1, width + 1);
  compressed.triangle.col(0).head(width) = factor.z;
  compressed.triangle(width, 0) = factor.rho;
  compressed.triangle.topRightCorner(width, width) = factor.R;
  return compressed;
}

/// The best theta for a given alpha, by rank-revealing least squares on the triangle.
Eigen::VectorXd SolveGiven(const Compressed& compressed, double alpha) {
  const Eigen::VectorXd constant = compressed.triangle.col(0) - alpha * compressed.triangle.col(1);
  return (-compressed.ByTheta(alpha)).completeOrthogonalDecomposition().solve(constant);
}

double SquaresGiven(const Compressed& compressed, double alpha) {
  return (compressed.triangle * compressed.Weights(alpha, SolveGiven(compressed, alpha)))
      .squaredNorm();
}

class LaggedCost : public ceres::CostFunction {
 public:
  LaggedCost(const Compressed& compressed, double scale) : compressed_(compressed), scale_(scale) {
    set_num_residuals(static_cast<int>(compressed.triangle.rows()));
    mutable_parameter_block_sizes()->push_back(1);
    mutable_parameter_block_sizes()->push_back(static_cast<int>(compressed.Coefficients()));
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const double alpha = parameters[0][0];
    const Eigen::VectorXd theta =
        Eigen::Map<const Eigen::VectorXd>(parameters[1], compressed_.Coefficients());
    Eigen::Map<Eigen::VectorXd>(residuals, num_residuals()) =
        scale_ * (compressed_.triangle * compressed_.Weights(alpha, theta));
    if (jacobians == nullptr) return true;
    if (jacobians[0] != nullptr) {
      Eigen::Map<Eigen::VectorXd>(jacobians[0], num_residuals()) =
          scale_ * (compressed_.triangle * compressed_.WeightsByAlpha(theta));
    }
    if (jacobians[1] != nullptr) {
      using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
      Eigen::Map<RowMajor>(jacobians[1], num_residuals(), compressed_.Coefficients()) =
          scale_ * compressed_.ByTheta(alpha);
    }
    return true;
  }

 private:
  const Compressed& compressed_;
  double scale_;
};

/// What the joint solve works on: the answered equations, in order.
struct Answered {
  std::vector<std::size_t> which;
  std::vector<ExcitedParts> parts;
  std::vector<Compressed> compressed;
};

double BestGridAlpha(const std::vector<Compressed>& equations) {
  // Each equation's misfit relative to its own at alpha = 0, so that none drowns the others.
  const auto misfit = [&](double alpha) {
    double sum = 0.0;
    for (const Compressed& equation : equations) {
      const double at_once = SquaresGiven(equation, 0.0);
      sum += at_once > 0.0 ? SquaresGiven(equation, alpha) / at_once : 0.0;
    }
    return sum;
  };
  constexpr int kGrid = 40;
  double best = 0.5;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 1; i < kGrid; ++i) {
    const double alpha = static_cast<double>(i) / kGrid;
    const double value = misfit(alpha);
    if (value < least) {
      least = value;
      best = alpha;
    }
  }
  return best;
}

double StandardDeviation(const Compressed& compressed, double alpha) {
  const auto freedom = static_cast<double>(compressed.rows - compressed.Coefficients() - 1);
  // Data made by the model itself leave nothing; a floor keeps the weights finite.
  const double floor = 1e-12 * compressed.triangle.col(0).norm();
  return std::max(std::sqrt(SquaresGiven(compressed, alpha) / freedom), floor);
}

double SolveJointly(const std::vector<Compressed>& equations, double start_alpha,
                    std::vector<Eigen::VectorXd>& theta) {
  double alpha = start_alpha;
  ceres::Problem joint;  // owns its cost functions
  for (std::size_t i = 0; i < equations.size(); ++i) {
    theta.push_back(SolveGiven(equations[i], start_alpha));
    const double scale = 1.0 / StandardDeviation(equations[i], start_alpha);
    joint.AddResidualBlock(new LaggedCost(equations[i], scale), nullptr, &alpha, theta[i].data());
  }
  joint.SetParameterLowerBound(&alpha, 0, kLeastAlpha);
  joint.SetParameterUpperBound(&alpha, 0, 1.0 - kLeastAlpha);
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 200;
  options.function_tolerance = 1e-16;
  options.gradient_tolerance = 1e-14;
  options.parameter_tolerance = 1e-14;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &joint, &summary);
  // For the final alpha the rest is linear; solving it so removes what the iterations left.
  for (std::size_t i = 0; i < equations.size(); ++i) theta[i] = SolveGiven(equations[i], alpha);
  return alpha;
}

EquationEstimate WriteEstimate(const Excitation& excitation, const Compressed& compressed,
                               double alpha, const Eigen::VectorXd& theta) {
  EquationEstimate estimate;
  estimate.equation = excitation.equation;
  estimate.columns = excitation.excited;
  estimate.theta = theta;
  estimate.estimable.assign(excitation.excited.size(), true);
  estimate.degrees_of_freedom =
      static_cast<double>(compressed.rows - compressed.Coefficients() - 1);
  estimate.residual_variance = std::pow(StandardDeviation(compressed, alpha), 2);
  return estimate;
}

/// Fills the joint Jacobian and residual, rows grouped by segment.
void StackRows(const LaggedProblem& problem, const Answered& answered, LaggedEstimate& estimate) {
  Eigen::Index rows = 0;
  Eigen::Index columns = 1;
  for (const Compressed& equation : answered.compressed) {
    rows += equation.rows;
    columns += equation.Coefficients();
  }
  estimate.jacobian = Eigen::MatrixXd::Zero(rows, columns);
  estimate.residual.resize(rows);
  const double alpha = estimate.alpha;
  const std::size_t segments = problem.equations[0].clusters.size();
  Eigen::Index row = 0;
  for (std::size_t s = 0; s < segments; ++s) {
    const auto first_row = static_cast<std::size_t>(row);
    Eigen::Index column = 1;
    for (std::size_t i = 0; i < answered.which.size(); ++i) {
      const LaggedEquation& lagged = problem.equations[answered.which[i]];
      const EquationEstimate& equation = *estimate.equations[answered.which[i]];
      const double weight = 1.0 / std::sqrt(equation.residual_variance);
      const auto begin = static_cast<Eigen::Index>(lagged.clusters[s].begin);
      const auto count = static_cast<Eigen::Index>(lagged.clusters[s].size());
      const ExcitedParts& parts = answered.parts[i];
      const auto body = static_cast<Eigen::Index>(parts.body.size());
      const auto propeller = static_cast<Eigen::Index>(parts.propeller.size());
      const Eigen::MatrixXd now = Select(lagged.now.middleRows(begin, count), parts.body);
      const Eigen::MatrixXd before = Select(lagged.before.middleRows(begin, count), parts.body);
      const Eigen::MatrixXd thrust = Select(lagged.thrust.middleRows(begin, count), parts.propeller);
      const Eigen::VectorXd theta_body = equation.theta.head(body);
      const Eigen::VectorXd theta_propeller = equation.theta.tail(propeller);
      const Eigen::VectorXd step_before = lagged.step_before.segment(begin, count);
      auto block = estimate.jacobian.middleRows(row, count);
      block.col(0) = weight * (step_before - before * theta_body - thrust * theta_propeller);
      block.middleCols(column, body) = weight * (now - alpha * before);
      block.middleCols(column + body, propeller) = weight * (1.0 - alpha) * thrust;
      estimate.residual.segment(row, count) =
          weight * (lagged.step_now.segment(begin, count) - alpha * step_before -
                    (now - alpha * before) * theta_body -
                    (1.0 - alpha) * (thrust * theta_propeller));
      row += count;
      column += body + propeller;
    }
    estimate.clusters.push_back({first_row, static_cast<std::size_t>(row)});
  }
}

}  // namespace

EquationProblem LaggedEquation::WithoutLag() const {
  EquationProblem problem;
  problem.equation = equation;
  problem.regressors = regressors;
  problem.phi.resize(now.rows(), now.cols() + thrust.cols());
  problem.phi << now, thrust;
  problem.y = step_now;
  problem.nu = nu;
  problem.clusters = clusters;
  return problem;
}

LaggedProblem BuildLagged(const PreparedDataset& dataset, const RegressionOptions& options) {
  Require(dataset.sampling_period_s > 0.0, "a positive sampling period");
  LaggedProblem problem;
  problem.parameterization = options.parameterization;
  problem.sampling_period_s = dataset.sampling_period_s;
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
    answered.compressed.push_back(Compress(problem.equations[j], answered.parts.back()));
  }
  Require(!answered.which.empty(), "at least one answered equation");

  LaggedEstimate estimate;
  std::vector<Eigen::VectorXd> theta;
  estimate.alpha = SolveJointly(answered.compressed, BestGridAlpha(answered.compressed), theta);
  estimate.time_constant_s = -problem.sampling_period_s / std::log(estimate.alpha);
  for (std::size_t i = 0; i < answered.which.size(); ++i) {
    const std::size_t j = answered.which[i];
    estimate.equations[j] =
        WriteEstimate(*excitations[j], answered.compressed[i], estimate.alpha, theta[i]);
  }
  StackRows(problem, answered, estimate);
  return estimate;
}

}  // namespace telltale
