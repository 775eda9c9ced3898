#include "telltale/core/estimation/regression/regression_problem.hpp"

#include <algorithm>

#include "telltale/core/base/contract.hpp"

namespace telltale {
namespace {

const RowRange& SegmentOf(const RowRange& slice, const std::vector<RowRange>& segments) {
  const auto found = std::find_if(segments.begin(), segments.end(), [&](const RowRange& s) {
    return slice.begin >= s.begin && slice.end <= s.end;
  });
  Require(found != segments.end(), "every slice inside a segment");
  return *found;
}

/// Indices k of a slice whose successor k + 1 belongs to the same gap-free segment.
RowRange PairsOf(const RowRange& slice, const std::vector<RowRange>& segments) {
  return {slice.begin, std::min(slice.end, SegmentOf(slice, segments).end - 1)};
}

std::size_t CountRows(const PreparedDataset& dataset, Equation equation,
                      const RegressionOptions& options) {
  std::size_t count = 0;
  for (const RowRange& slice : dataset.slices) {
    const RowRange pairs = PairsOf(slice, dataset.segments);
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
  Eigen::RowVectorXd regressors(static_cast<Eigen::Index>(problem.regressors.size()));
  problem.phi.resize(rows, regressors.size());
  problem.instants.reserve(static_cast<std::size_t>(rows));
  problem.y.resize(rows);
  problem.nu.resize(rows);
  Eigen::Index row = 0;
  for (const RowRange& slice : dataset.slices) {
    const auto first = static_cast<std::size_t>(row);
    const RowRange pairs = PairsOf(slice, dataset.segments);
    for (std::size_t k = pairs.begin; k < pairs.end; ++k) {
      const PreparedRow& now = dataset.rows[k];
      if (!Enters(now.region, equation, options)) continue;
      FillRow(equation, options.parameterization, now.nu, options.dead_zone.Apply(now.delta),
              {regressors.data(), problem.regressors.size()});
      problem.phi.row(row) = regressors;
      problem.nu[row] = ComponentOf(now.nu, equation);
      problem.instants.push_back(k);
      problem.y[row] =
          (ComponentOf(dataset.rows[k + 1].nu, equation) - ComponentOf(now.nu, equation)) /
          dataset.sampling_period_s;
      ++row;
    }
    problem.clusters.push_back({first, static_cast<std::size_t>(row)});
  }
  return problem;
}

/// Yaw has the rows and the regressors of sway.
EquationProblem YawBeside(const EquationProblem& sway, const PreparedDataset& dataset,
                          const RegressionOptions& options) {
  EquationProblem yaw = sway;
  yaw.equation = Equation::kYaw;
  yaw.regressors = Regressors(yaw.equation, options.parameterization);
  for (std::size_t i = 0; i < yaw.instants.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const std::size_t k = yaw.instants[i];
    yaw.nu[row] = dataset.rows[k].nu.r;
    yaw.y[row] = (dataset.rows[k + 1].nu.r - yaw.nu[row]) / dataset.sampling_period_s;
  }
  return yaw;
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

RowRange InstantsAfter(const RowRange& slice, const std::vector<RowRange>& segments) {
  const std::size_t end = std::min(slice.end + 1, SegmentOf(slice, segments).end - 1);
  return {std::min(slice.begin + 1, end), end};
}

RegressionProblem BuildRegression(const PreparedDataset& dataset,
                                  const RegressionOptions& options) {
  Require(options.structure == Structure::kStaticQuadratic, "the static structure");
  Require(dataset.sampling_period_s > 0.0, "a positive sampling period");
  RegressionProblem problem;
  problem.structure = options.structure;
  problem.parameterization = options.parameterization;
  problem.sampling_period_s = dataset.sampling_period_s;
  auto& [surge, sway, yaw] = problem.equations;
  surge = BuildEquation(dataset, Equation::kSurge, options);
  sway = BuildEquation(dataset, Equation::kSway, options);
  yaw = YawBeside(sway, dataset, options);
  return problem;
}

}  // namespace telltale
