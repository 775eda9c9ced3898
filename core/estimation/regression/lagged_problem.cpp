#include "telltale/core/estimation/regression/lagged_problem.hpp"

namespace telltale {

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

LaggedThrust LagThrust(const LaggedProblem& problem, const LagPerPeriod& lag) {
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

}  // namespace telltale
