#include "telltale/core/paper/redundant_least_squares.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <boost/math/tools/minima.hpp>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/estimation/regression/triangular_factor.hpp"

namespace telltale {
namespace {

constexpr std::array kSurgeRegressors = {
    RedundantRegressor{"u(k)", "alpha + h Ru1"},
    RedundantRegressor{"u|u|(k-1)", "-alpha h Pu11"},
    RedundantRegressor{"vr(k-1)", "-alpha h 2Qu23"},
    RedundantRegressor{"rr(k-1)", "-alpha h Qu33"},
    RedundantRegressor{"u(k-1)", "-alpha (1 + h Ru1)"},
    RedundantRegressor{"u|u|(k)", "h Pu11"},
    RedundantRegressor{"vr(k)", "h 2Qu23"},
    RedundantRegressor{"rr(k)", "h Qu33"},
    RedundantRegressor{"1", "(1 - alpha) h cu"},
    RedundantRegressor{"mean^2+diff^2/4(k-1)", "h beta 2W11af"},
    RedundantRegressor{"mean(k-1)", "h beta 2W11bf"},
};

constexpr std::array kSwayRegressors = {
    RedundantRegressor{"v(k)", "alpha + h Rv2"},
    RedundantRegressor{"v|v|(k-1)", "-alpha h Pv22"},
    RedundantRegressor{"v|r|(k-1)", "-alpha h Pv23"},
    RedundantRegressor{"r|v|(k-1)", "-alpha h Pv32"},
    RedundantRegressor{"r|r|(k-1)", "-alpha h Pv33"},
    RedundantRegressor{"uv(k-1)", "-alpha h 2Qv12"},
    RedundantRegressor{"ur(k-1)", "-alpha h 2Qv13"},
    RedundantRegressor{"v(k-1)", "-alpha (1 + h Rv2)"},
    RedundantRegressor{"r(k-1)", "-alpha h Rv3"},
    RedundantRegressor{"v|v|(k)", "h Pv22"},
    RedundantRegressor{"v|r|(k)", "h Pv23"},
    RedundantRegressor{"r|v|(k)", "h Pv32"},
    RedundantRegressor{"r|r|(k)", "h Pv33"},
    RedundantRegressor{"uv(k)", "h 2Qv12"},
    RedundantRegressor{"ur(k)", "h 2Qv13"},
    RedundantRegressor{"r(k)", "h Rv3"},
    RedundantRegressor{"1", "(1 - alpha) h cv"},
    RedundantRegressor{"mean^2+diff^2/4(k-1)", "h beta W23(aL-aR)"},
    RedundantRegressor{"mean*diff(k-1)", "h beta W23(aL+aR)"},
    RedundantRegressor{"mean(k-1)", "h beta W23(bL-bR)"},
    RedundantRegressor{"diff/2(k-1)", "h beta W23(bL+bR)"},
};

constexpr std::array kYawRegressors = {
    RedundantRegressor{"r(k)", "alpha + h Rr3"},
    RedundantRegressor{"v|v|(k-1)", "-alpha h Pr22"},
    RedundantRegressor{"v|r|(k-1)", "-alpha h Pr23"},
    RedundantRegressor{"r|v|(k-1)", "-alpha h Pr32"},
    RedundantRegressor{"r|r|(k-1)", "-alpha h Pr33"},
    RedundantRegressor{"uv(k-1)", "-alpha h 2Qr12"},
    RedundantRegressor{"ur(k-1)", "-alpha h 2Qr13"},
    RedundantRegressor{"v(k-1)", "-alpha h Rr2"},
    RedundantRegressor{"r(k-1)", "-alpha (1 + h Rr3)"},
    RedundantRegressor{"v|v|(k)", "h Pr22"},
    RedundantRegressor{"v|r|(k)", "h Pr23"},
    RedundantRegressor{"r|v|(k)", "h Pr32"},
    RedundantRegressor{"r|r|(k)", "h Pr33"},
    RedundantRegressor{"uv(k)", "h 2Qr12"},
    RedundantRegressor{"ur(k)", "h 2Qr13"},
    RedundantRegressor{"v(k)", "h Rr2"},
    RedundantRegressor{"1", "(1 - alpha) h cr"},
    RedundantRegressor{"mean^2+diff^2/4(k-1)", "h beta W33(aL-aR)"},
    RedundantRegressor{"mean*diff(k-1)", "h beta W33(aL+aR)"},
    RedundantRegressor{"mean(k-1)", "h beta W33(bL-bR)"},
    RedundantRegressor{"diff/2(k-1)", "h beta W33(bL+bR)"},
};

// Position of the second linear term, -alpha (1 + h R).
std::size_t SecondLinearTerm(Equation equation) {
  switch (equation) {
    case Equation::kSurge: return 4;
    case Equation::kSway: return 7;
    default: return 8;
  }
}

// FillBody writes the body terms of an instant in the order of the static regression. The values it
// writes past them are overwritten next.

void FillSurge(const Nu& now, const Nu& before, const ThrustRegressors& thrust,
               std::span<double> row) {
  row[0] = now.u;
  FillBody(Equation::kSurge, before, row.subspan(1));
  FillBody(Equation::kSurge, now, row.subspan(5));
  row[8] = 1.0;
  std::copy_n(thrust.surge.begin(), 2, row.begin() + 9);
}

void FillTurning(Equation equation, const Nu& now, const Nu& before, const ThrustRegressors& thrust,
                 std::span<double> row) {
  const bool sway = equation == Equation::kSway;
  row[0] = sway ? now.v : now.r;
  FillBody(equation, before, row.subspan(1));
  FillBody(equation, now, row.subspan(9));
  row[15] = sway ? now.r : now.v;
  row[16] = 1.0;
  std::copy_n(thrust.turning.begin(), 4, row.begin() + 17);
}

std::array<std::complex<double>, 2> Roots(double first, double second) {
  const std::complex<double> root =
      std::sqrt(std::complex<double>((1.0 + first) * (1.0 + first) + 4.0 * second));
  return {(1.0 + first + root) / 2.0, (1.0 + first - root) / 2.0};
}

}  // namespace

std::span<const RedundantRegressor> RedundantRegressors(Equation equation) {
  switch (equation) {
    case Equation::kSurge: return kSurgeRegressors;
    case Equation::kSway: return kSwayRegressors;
    case Equation::kYaw: return kYawRegressors;
    case Equation::kUnknown: break;
  }
  throw ContractViolation("RedundantRegressors: requires a named equation");
}

void FillRedundantRow(Equation equation, const Nu& now, const Nu& before,
                      const PropellerCommand& delta_before, std::span<double> row) {
  const ThrustRegressors thrust = ThrustOf(Parameterization::kPaper, delta_before);
  if (equation == Equation::kSurge) {
    FillSurge(now, before, thrust, row);
  } else {
    FillTurning(equation, now, before, thrust, row);
  }
}

EquationProblem BuildRedundant(const PreparedDataset& dataset, Equation equation,
                               const RegressionOptions& options) {
  RegressionOptions paper = options;
  paper.parameterization = Parameterization::kPaper;
  const std::size_t columns = RedundantRegressors(equation).size();
  const double h = dataset.sampling_period_s;
  EquationProblem problem;
  problem.equation = equation;
  std::vector<std::size_t> instants;
  for (const RowRange& slice : dataset.slices) {
    const std::size_t first = instants.size();
    const RowRange range = InstantsAfter(slice, dataset.segments);
    for (std::size_t k = range.begin; k < range.end; ++k) {
      if (Enters(dataset.rows[k - 1].region, equation, paper)) instants.push_back(k);
    }
    problem.clusters.push_back({first, instants.size()});
  }
  problem.instants = instants;
  const auto rows = static_cast<Eigen::Index>(instants.size());
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> A(
      rows, static_cast<Eigen::Index>(columns));
  problem.y.resize(rows);
  problem.nu.resize(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const std::size_t k = instants[static_cast<std::size_t>(i)];
    const PreparedRow& now = dataset.rows[k];
    const PreparedRow& before = dataset.rows[k - 1];
    FillRedundantRow(equation, now.nu, before.nu, options.dead_zone.Apply(before.delta),
                     {A.row(i).data(), columns});
    problem.nu[i] = ComponentOf(now.nu, equation);
    problem.y[i] = (ComponentOf(dataset.rows[k + 1].nu, equation) - problem.nu[i]) / h;
  }
  problem.phi = A / h;
  return problem;
}

Result<Eigen::VectorXd> EstimateRedundant(const EquationProblem& problem) {
  const std::string subject = std::string(Name(problem.equation)) + " redundant";
  const Eigen::Index columns = problem.phi.cols();
  if (problem.phi.rows() < 10 * columns) {
    return Refuse(subject,
                  "only " + std::to_string(problem.phi.rows()) + " usable rows, " +
                      std::to_string(10 * columns) + " are needed",
                  "record for longer in the regions this equation uses");
  }
  const Eigen::VectorXd norms =
      problem.phi.colwise().norm().transpose().cwiseMax(std::numeric_limits<double>::min());
  const TriangularFactor factor =
      Triangularise(problem.phi * norms.cwiseInverse().asDiagonal(), problem.y);
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(factor.R, Eigen::ComputeFullU | Eigen::ComputeFullV);
  if (svd.rank() < columns) {
    return Refuse(subject,
                  "only " + std::to_string(svd.rank()) + " of " + std::to_string(columns) +
                      " columns are linearly independent",
                  "use the consistent estimate, which has one value per physical coefficient");
  }
  return Eigen::VectorXd(svd.solve(factor.z).cwiseQuotient(norms));
}

RedundantAlpha RecoverAlpha(const std::array<Eigen::VectorXd, 3>& redundant) {
  std::array<double, 3> first{};
  std::array<double, 3> second{};
  RedundantAlpha recovered;
  for (const Equation equation : kEquations) {
    const std::size_t j = IndexOf(equation);
    Require(static_cast<std::size_t>(redundant[j].size()) == RedundantRegressors(equation).size(),
            "a coefficient per redundant regressor");
    first[j] = redundant[j][0];
    second[j] = redundant[j][static_cast<Eigen::Index>(SecondLinearTerm(equation))];
    recovered.roots[j] = Roots(first[j], second[j]);
  }
  // The sum of squares at a given alpha, minimised over h R of each equation in closed form.
  const auto misfit = [&](double alpha) {
    double sum = 0.0;
    for (std::size_t j = 0; j < 3; ++j) {
      const double defect = second[j] + alpha * (1.0 + first[j]) - alpha * alpha;
      sum += defect * defect / (1.0 + alpha * alpha);
    }
    return sum;
  };
  // The misfit may have two minima in (0, 1); the lowest point of a fine grid selects one.
  constexpr int kGrid = 1000;
  double best = 0.0;
  for (int i = 1; i < kGrid; ++i) {
    const double alpha = static_cast<double>(i) / kGrid;
    if (best == 0.0 || misfit(alpha) < misfit(best)) best = alpha;
  }
  const double low = std::max(best - 1.0 / kGrid, 1e-12);
  const double high = std::min(best + 1.0 / kGrid, 1.0 - 1e-12);
  const auto minimum = boost::math::tools::brent_find_minima(misfit, low, high, 52);
  recovered.alpha = minimum.first;
  recovered.residual = std::sqrt(minimum.second / 6.0);

  constexpr double kSame = 0.05;
  recovered.agree = std::all_of(recovered.roots.begin(), recovered.roots.end(), [&](const auto& r) {
    return std::any_of(r.begin(), r.end(), [&](const std::complex<double>& root) {
      return root.imag() == 0.0 && root.real() > 0.0 && root.real() < 1.0 &&
             std::abs(root.real() - recovered.alpha) < kSame;
    });
  });
  return recovered;
}

}  // namespace telltale
