#include "telltale/core/estimation/regression/excitation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/base/format_number.hpp"
#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/base/range.hpp"
#include "telltale/core/estimation/regression/insufficient_excitation.hpp"

namespace telltale {
namespace {

// A thrust term is at work in a row when it is the term of a command of at least this size.
constexpr double kActiveCommand = 0.05;

/// Rows in which its propeller works excite a thrust column; any motion excites a body column.
bool IsExcited(const EquationProblem& problem, std::size_t column, const ExcitationLimits& limits) {
  const auto values = problem.phi.col(static_cast<Eigen::Index>(column)).array().abs();
  const Regressor& regressor = problem.regressors[column];
  if (!regressor.is_propeller) return values.maxCoeff() > 1e-9;
  const bool quadratic = regressor.name.find("^2") != std::string_view::npos;
  const double active = quadratic ? kActiveCommand * kActiveCommand : kActiveCommand;
  return static_cast<std::size_t>((values > active).count()) >= limits.fewest_active_rows;
}

std::vector<std::size_t> ExcitedOf(const EquationProblem& problem, const ExcitationLimits& limits) {
  std::vector<std::size_t> excited;
  for (std::size_t column = 0; column < problem.regressors.size(); ++column) {
    if (IsExcited(problem, column, limits)) excited.push_back(column);
  }
  return excited;
}

/// Factors of the named columns of Phi. Usually these are all of them, and nothing is copied.
std::vector<TriangularFactor> FactorsOf(const Eigen::MatrixXd& phi,
                                        const std::vector<std::size_t>& columns,
                                        const Eigen::Ref<const Eigen::MatrixXd>& Y) {
  if (columns.size() == static_cast<std::size_t>(phi.cols())) return TriangulariseAll(phi, Y);
  return TriangulariseAll(phi(Eigen::all, columns), Y);
}

/// Belsley: a column belongs to the dependency of a singular value by the share of its variance
/// that this singular value causes.
std::vector<CollinearGroup> FindCollinear(const Excitation& excitation, double limit) {
  const Eigen::VectorXd& s = excitation.singular_values;
  const Eigen::VectorXd floored = s.cwiseMax(s[0] * std::numeric_limits<double>::epsilon());
  const Eigen::MatrixXd shares =
      (excitation.right_singular_vectors.array().rowwise() / floored.transpose().array()).square();
  const Eigen::VectorXd variances = shares.rowwise().sum();
  std::vector<CollinearGroup> groups;
  for (Eigen::Index k = 0; k < s.size(); ++k) {
    CollinearGroup group;
    group.condition_index = s[0] / floored[k];
    if (group.condition_index < limit) continue;
    for (Eigen::Index j = 0; j < s.size(); ++j) {
      if (shares(j, k) / variances[j] > kDependencyVarianceShare) {
        group.columns.push_back(excitation.excited[static_cast<std::size_t>(j)]);
      }
    }
    if (group.columns.size() > 1) groups.push_back(group);
  }
  return groups;
}

/// The triangle has the same column norms as Phi, so its columns are scaled in place of those.
Excitation Decomposed(Equation equation, std::vector<std::size_t> excited, TriangularFactor factor,
                      const ExcitationLimits& limits) {
  Excitation excitation;
  excitation.equation = equation;
  excitation.excited = std::move(excited);
  excitation.factor = std::move(factor);
  excitation.column_norms = excitation.factor.R.colwise().norm();
  excitation.factor.R.array().rowwise() /= excitation.column_norms.transpose().array();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(excitation.factor.R,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  excitation.singular_values = svd.singularValues();
  excitation.left_singular_vectors = svd.matrixU();
  excitation.right_singular_vectors = svd.matrixV();
  const double smallest = excitation.singular_values[0] * std::numeric_limits<double>::epsilon() *
                          static_cast<double>(excitation.factor.rows);
  excitation.rank = (excitation.singular_values.array() > smallest).count();
  excitation.collinear = FindCollinear(excitation, limits.collinear_condition_index);
  return excitation;
}

/// The excitations of two equations with the same regressors and rows.
std::array<Excitation, 2> AssessTogether(const EquationProblem& one, const EquationProblem& other,
                                         const ExcitationLimits& limits) {
  Eigen::MatrixXd Y(one.y.size(), 2);
  Y << one.y, other.y;
  const std::vector<std::size_t> excited = ExcitedOf(one, limits);
  std::vector<TriangularFactor> factors = FactorsOf(one.phi, excited, Y);
  Excitation first = Decomposed(one.equation, excited, std::move(factors[0]), limits);
  Excitation second = first;
  second.equation = other.equation;
  second.factor.z = std::move(factors[1].z);
  second.factor.rho = factors[1].rho;
  return {std::move(first), std::move(second)};
}

}  // namespace

std::optional<Refusal> ExcitationLimits::Validate() const {
  const std::string_view subject = "excitation";
  const std::array checks = {
      OutOfRange(subject, "rows_per_coefficient", rows_per_coefficient, 2.0, 1000.0),
      OutOfRange(subject, "surge_speed_spread_mps", surge_speed_spread_mps, 0.0, 10.0),
      OutOfRange(subject, "yaw_rate_spread_radps", yaw_rate_spread_radps, 0.0, 3.0),
      OutOfRange(subject, "command_spread", command_spread, 0.0, 1.0),
      OutOfRange(subject, "fewest_active_rows", static_cast<double>(fewest_active_rows), 1.0, 1e4),
      OutOfRange(subject, "collinear_condition_index", collinear_condition_index, 10.0, 1e6)};
  for (const auto& refusal : checks) {
    if (refusal) return refusal;
  }
  return std::nullopt;
}

Result<Excitation> Assess(const EquationProblem& problem, const ExcitationLimits& limits) {
  Require(problem.equation != Equation::kUnknown, "a named equation");
  if (auto refusal = RefuseInsufficientExcitation(problem, limits))
    return tl::unexpected(*std::move(refusal));
  const std::vector<std::size_t> excited = ExcitedOf(problem, limits);
  std::vector<TriangularFactor> factors = FactorsOf(problem.phi, excited, problem.y);
  return Decomposed(problem.equation, excited, std::move(factors.front()), limits);
}

std::array<Result<Excitation>, 3> Assess(const std::array<EquationProblem, 3>& problems,
                                         const ExcitationLimits& limits) {
  const auto& [surge, sway, yaw] = problems;
  if (sway.instants != yaw.instants || RefuseInsufficientExcitation(sway, limits) ||
      RefuseInsufficientExcitation(yaw, limits)) {
    return {Assess(surge, limits), Assess(sway, limits), Assess(yaw, limits)};
  }
  auto [of_sway, of_yaw] = AssessTogether(sway, yaw, limits);
  return {Assess(surge, limits), std::move(of_sway), std::move(of_yaw)};
}

Refusal Explain(const CollinearGroup& group, const EquationProblem& problem) {
  std::string names;
  bool thrust = false;
  for (const std::size_t column : group.columns) {
    names += (names.empty() ? "" : ", ") + std::string(problem.regressors[column].name);
    thrust = thrust || problem.regressors[column].is_propeller;
  }
  return {std::string(Name(problem.equation)) + " " + names,
          "these are collinear: the data move them together (condition index " +
              FormatSignificant(group.condition_index, 3) + ")",
          thrust ? "add steps of the command between small and full, in each direction of turning"
                 : "add zigzags and circles at two or more speeds"};
}

}  // namespace telltale
