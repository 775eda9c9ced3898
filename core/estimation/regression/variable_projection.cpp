#include "telltale/core/estimation/regression/variable_projection.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/estimation/regression/triangular_factor.hpp"

namespace telltale {
namespace {

// Initial thrust that has decayed to this share of itself is negligible.
constexpr double kForgotten = 1e-12;

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

/// Projects alpha^m out of the rows of each segment. alpha is the share of a lag that remains after
/// a sampling period; m counts rows from the start of the segment.
void ProjectInitialThrust(const LaggedProblem& problem, const EquationProblem& equation,
                          const LagPerPeriod& lag, EquationAtLag& at) {
  if (lag.remaining < kForgotten) return;
  const auto rows_of = RowsOfSegments(equation, problem.segments);
  for (std::size_t s = 0; s < rows_of.size(); ++s) {
    const auto begin = static_cast<Eigen::Index>(rows_of[s].begin);
    // Beyond these rows the initial thrust has decayed and the direction is zero.
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

}  // namespace

EquationAtLag ProjectAt(const LaggedProblem& problem, const EquationProblem& equation,
                        const std::vector<std::size_t>& excited, const LaggedThrust& thrust,
                        const LagPerPeriod& lag) {
  const std::size_t body = BodyRegressors(equation.equation);
  const auto first_thrust = std::lower_bound(excited.begin(), excited.end(), body);
  const auto propellers = excited.end() - first_thrust;
  const auto bodies = first_thrust - excited.begin();
  EquationAtLag at;
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

SolutionAtLag SolveAt(const EquationAtLag& at) {
  const Eigen::Index p = at.phi.cols();
  const Eigen::Index q = at.slope.cols();
  const Eigen::VectorXd norms =
      at.phi.colwise().norm().transpose().cwiseMax(std::numeric_limits<double>::min());
  Eigen::MatrixXd both(at.phi.rows(), p + q);
  both << at.phi * norms.cwiseInverse().asDiagonal(), at.slope;
  const TriangularFactor factor = Triangularise(both, at.y);

  SolutionAtLag solved;
  const Eigen::MatrixXd corner = factor.R.topLeftCorner(p, p);
  const Eigen::VectorXd right = factor.z.head(p);
  const auto decomposition = corner.completeOrthogonalDecomposition();
  solved.theta = decomposition.solve(right).cwiseQuotient(norms);
  // The residual of the first p rows is zero unless columns are collinear; the rest of the triangle
  // follows.
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
  // Data simulated by the model itself leave no residual; a floor keeps the weights finite.
  const double floor = 1e-12 * at.y.norm();
  solved.variance =
      std::max(solved.residual.squaredNorm(), floor * floor) / solved.degrees_of_freedom;
  return solved;
}

}  // namespace telltale
