#include "telltale/core/estimation/weak_form/projected_equations.hpp"

#include <limits>

#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"

namespace telltale {
namespace {

/// Sway and yaw have the same regressors, so what is projected of sway serves both where their
/// supports are the same.
bool ServesYaw(const WeakProblem& problem, const ProjectedEquations& before) {
  const std::size_t sway = IndexOf(Equation::kSway);
  return !before.empty() && before.back().index == sway &&
         problem.supports[sway].first_rows == problem.supports[IndexOf(Equation::kYaw)].first_rows;
}

/// A x = c by ridge regression, with rows and columns of A scaled by these norms.
Eigen::VectorXd SolveRidge(const Eigen::MatrixXd& A, const Eigen::VectorXd& c,
                           const Eigen::VectorXd& z_norms, const Eigen::VectorXd& g_norms,
                           double ridge) {
  const Eigen::MatrixXd S =
      z_norms.cwiseInverse().asDiagonal() * A * g_norms.cwiseInverse().asDiagonal();
  Eigen::MatrixXd normal = S.transpose() * S;
  normal.diagonal().array() += ridge * ridge;
  const Eigen::VectorXd right = S.transpose() * z_norms.cwiseInverse().asDiagonal() * c;
  return normal.ldlt().solve(right).cwiseQuotient(g_norms);
}

}  // namespace

ProjectedEquations ProjectEquations(const PreparedDataset& dataset, const WeakProblem& problem,
                                    const FilteredThrust& thrust,
                                    const std::array<std::vector<std::size_t>, 3>& columns) {
  ProjectedEquations equations;
  Eigen::MatrixXd projected;
  for (std::size_t j = 0; j < columns.size(); ++j) {
    if (columns[j].empty()) continue;
    if (kEquations[j] != Equation::kYaw || !ServesYaw(problem, equations)) {
      projected = ProjectRegressors(dataset, problem, thrust, kEquations[j]);
    }
    equations.push_back(
        {j, columns[j], projected(Eigen::all, columns[j]),
         ProjectAcceleration(problem, problem.supports[j], dataset, kEquations[j])});
  }
  return equations;
}

std::vector<Eigen::MatrixXd> LagDerivatives(const PreparedDataset& dataset,
                                            const WeakProblem& problem,
                                            const ProjectedEquations& equations,
                                            const Thetas& thetas, double time_constant_s) {
  const double apart_s = 0.02 * time_constant_s;
  const FilteredThrust shorter = FilterThrust(dataset, problem, time_constant_s - apart_s);
  const FilteredThrust longer = FilterThrust(dataset, problem, time_constant_s + apart_s);
  std::vector<Eigen::MatrixXd> slopes;
  for (std::size_t i = 0; i < equations.size(); ++i) {
    const Equation name = kEquations[equations[i].index];
    const Eigen::MatrixXd change =
        (ProjectRegressors(dataset, problem, longer, name) -
         ProjectRegressors(dataset, problem, shorter, name))(Eigen::all, equations[i].columns);
    slopes.emplace_back(change * thetas[i] / (2.0 * apart_s));
  }
  return slopes;
}

Thetas SolveLeastSquares(const ProjectedEquations& equations) {
  Thetas thetas;
  for (const ProjectedEquation& equation : equations) {
    thetas.emplace_back(equation.G.colPivHouseholderQr().solve(equation.b));
  }
  return thetas;
}

Eigen::VectorXd SolveRegularised(const ProjectedEquation& equation, const Eigen::MatrixXd& Z,
                                 double ridge) {
  return SolveRidge(Z.transpose() * equation.G, Z.transpose() * equation.b, ColumnNorms(Z),
                    ColumnNorms(equation.G), ridge);
}

Eigen::VectorXd ColumnNorms(const Eigen::MatrixXd& columns) {
  return columns.colwise().norm().transpose().cwiseMax(std::numeric_limits<double>::min());
}

VesselModel ModelWith(const WeakProblem& problem, const ProjectedEquations& equations,
                      const Thetas& thetas) {
  VesselModel model = VesselModel::OfZeros(Structure::kStaticQuadratic, problem.parameterization,
                                           Discretisation::kContinuous);
  for (std::size_t i = 0; i < equations.size(); ++i) {
    Eigen::VectorXd& theta = model.theta[equations[i].index];
    for (std::size_t j = 0; j < equations[i].columns.size(); ++j) {
      const auto column = static_cast<Eigen::Index>(equations[i].columns[j]);
      if (column < theta.size()) theta[column] = thetas[i][static_cast<Eigen::Index>(j)];
    }
  }
  return model;
}

}  // namespace telltale
