#include "telltale/core/estimation/weak_form/separable_columns.hpp"

#include <algorithm>
#include <limits>

#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/estimation/weak_form/projection.hpp"

namespace telltale {
namespace {

/// A column belongs to a dependency when its component exceeds this share of the largest one.
/// Leaving the largest column out changes the coefficient of this one by as much.
constexpr double kLeastComponent = 0.01;

struct Dependency {
  CollinearGroup group;
  std::size_t largest = 0;  ///< place of the largest component among the columns given
};

/// The closest linear dependency among these columns of a projected equation.
Dependency ClosestDependency(const Eigen::MatrixXd& projected,
                             const std::vector<std::size_t>& columns) {
  constexpr double kLeast = std::numeric_limits<double>::min();
  const Eigen::MatrixXd chosen = projected(Eigen::all, columns);
  const Eigen::VectorXd norms = chosen.colwise().norm().transpose().cwiseMax(kLeast);
  const Eigen::MatrixXd unit = chosen * norms.cwiseInverse().asDiagonal();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(unit, Eigen::ComputeThinV);
  const Eigen::VectorXd& s = svd.singularValues();
  const Eigen::VectorXd components = svd.matrixV().rightCols<1>().cwiseAbs();
  Dependency dependency;
  Eigen::Index largest = 0;
  components.maxCoeff(&largest);
  dependency.largest = static_cast<std::size_t>(largest);
  dependency.group.condition_index = s[0] / std::max(s[s.size() - 1], kLeast);
  for (std::size_t j = 0; j < columns.size(); ++j) {
    if (components[static_cast<Eigen::Index>(j)] > kLeastComponent * components[largest]) {
      dependency.group.columns.push_back(columns[j]);
    }
  }
  return dependency;
}

}  // namespace

SeparableColumns Separate(const PreparedDataset& dataset, const RegressionOptions& regression,
                          const std::array<std::vector<std::size_t>, 3>& columns,
                          const WeakFormOptions& form, double worst_condition) {
  const WeakProblem problem = BuildWeakForm(dataset, regression, form);
  const FilteredThrust thrust = FilterThrust(dataset, problem, std::nullopt);
  SeparableColumns separable{columns, {}};
  for (const Equation equation : kEquations) {
    const std::size_t j = IndexOf(equation);
    std::vector<std::size_t>& kept = separable.kept[j];
    const Eigen::MatrixXd projected = ProjectRegressors(dataset, problem, thrust, equation);
    if (projected.rows() <= static_cast<Eigen::Index>(kept.size())) continue;
    while (kept.size() > 1) {
      const Dependency dependency = ClosestDependency(projected, kept);
      if (dependency.group.condition_index < worst_condition) break;
      separable.groups[j].push_back(dependency.group);
      kept.erase(kept.begin() + static_cast<std::ptrdiff_t>(dependency.largest));
    }
  }
  return separable;
}

}  // namespace telltale
