#include "estimation/regression_problem.hpp"

#include <algorithm>

#include "contract.hpp"

namespace telltale {
namespace {

const RowRange& StretchOf(const RowRange& segment, const std::vector<RowRange>& stretches) {
  const auto found = std::find_if(stretches.begin(), stretches.end(), [&](const RowRange& s) {
    return segment.begin >= s.begin && segment.end <= s.end;
  });
  Require(found != stretches.end(), "every segment inside a stretch");
  return *found;
}

/// Indices k of a segment whose successor k + 1 belongs to the same gap-free stretch.
RowRange PairsOf(const RowRange& segment, const std::vector<RowRange>& stretches) {
  return {segment.begin, std::min(segment.end, StretchOf(segment, stretches).end - 1)};
}

std::size_t CountRows(const PreparedDataset& dataset, Equation equation,
                      const RegressionOptions& options) {
  std::size_t count = 0;
  for (const RowRange& segment : dataset.segments) {
    const RowRange pairs = PairsOf(segment, dataset.stretches);
    for (std::size_t k = pairs.begin; k < pairs.end; ++k) {
      count += Enters(dataset.rows[k].region, equation, options) ? 1 : 0;
    }
  }
  return count;
}

EquationProblem BuildEquation(const PreparedDataset& dataset, Equation equation,
                              const RegressionOptions& options) {
  EquationProblem problem;
  problem.equation = equation;
  problem.regressors = Regressors(equation, options.parameterization);
  const auto rows = static_cast<Eigen::Index>(CountRows(dataset, equation, options));
  const auto columns = static_cast<Eigen::Index>(problem.regressors.size());
  // Filled row by row, kept row-major for that reason while it is built.
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> phi(rows, columns);
  problem.y.resize(rows);
  problem.nu.resize(rows);
  Eigen::Index row = 0;
  for (const RowRange& segment : dataset.segments) {
    const auto first = static_cast<std::size_t>(row);
    const RowRange pairs = PairsOf(segment, dataset.stretches);
    for (std::size_t k = pairs.begin; k < pairs.end; ++k) {
      const PreparedRow& now = dataset.rows[k];
      if (!Enters(now.region, equation, options)) continue;
      FillRow(equation, options.parameterization, now.nu, options.dead_zone.Apply(now.delta),
              {phi.row(row).data(), problem.regressors.size()});
      problem.nu[row] = ComponentOf(now.nu, equation);
      problem.instants.push_back(k);
      problem.y[row] =
          (ComponentOf(dataset.rows[k + 1].nu, equation) - ComponentOf(now.nu, equation)) /
          dataset.sampling_period_s;
      ++row;
    }
    problem.clusters.push_back({first, static_cast<std::size_t>(row)});
  }
  problem.phi = phi;
  return problem;
}

}  // namespace

/// Surge in the paper's parameterization has one thrust curve, the forward one, so it holds in FF
/// alone.
bool Enters(PropellerRegion region, Equation equation, const RegressionOptions& options) {
  if (region == PropellerRegion::kRR && !options.include_reverse) return false;
  const bool forward_only =
      equation == Equation::kSurge && options.parameterization == Parameterization::kPaper;
  return !forward_only || region == PropellerRegion::kFF;
}

RowRange InstantsAfter(const RowRange& segment, const std::vector<RowRange>& stretches) {
  const std::size_t end = std::min(segment.end + 1, StretchOf(segment, stretches).end - 1);
  return {std::min(segment.begin + 1, end), end};
}

RegressionProblem BuildRegression(const PreparedDataset& dataset,
                                  const RegressionOptions& options) {
  Require(options.structure == Structure::kStaticQuadratic, "the static structure");
  Require(dataset.sampling_period_s > 0.0, "a positive sampling period");
  RegressionProblem problem;
  problem.structure = options.structure;
  problem.parameterization = options.parameterization;
  problem.sampling_period_s = dataset.sampling_period_s;
  for (const Equation equation : kEquations) {
    problem.equations[IndexOf(equation)] = BuildEquation(dataset, equation, options);
  }
  return problem;
}

}  // namespace telltale
