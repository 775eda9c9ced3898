#pragma once

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/regression/excitation.hpp"
#include "telltale/core/estimation/regression/regression_problem.hpp"
#include "telltale/core/vessel/propellers.hpp"

namespace telltale {

/// The estimate of one limit of the dead zone.
struct DeadZoneLimit {
  double estimate = 0.0;
  /// How far -2 log likelihood rises over the range allowed, in steps of 0.05, the other limit
  /// following along. Small: every value of this limit explains the data as well as any other.
  double contrast = 0.0;
  bool determined = false;  ///< contrast above kLeastContrast and the estimate off the far edge
};

/// Chi-square of one degree of freedom is above this once in a thousand. Residuals that are
/// coloured count for less than their number, hence no looser threshold.
inline constexpr double kLeastContrast = 10.83;

struct DeadZoneEstimate {
  DeadZoneLimit forward;  ///< in [0, kWidestDeadZone]
  DeadZoneLimit reverse;  ///< in [-kWidestDeadZone, 0]
};

/// The dead zone that explains the data best, for the structure and parameterization of `options`
/// (whose own dead zone is of no account). Model: for each pair of limits the rest is least
/// squares; minimises sum_j n_j log RSS_j over the equations the data can answer, which is the sum
/// of squares weighted by each equation's own residual variance. docs/concepts/model.md (7).
/// Method: a grid of 0.05 over both limits, then a compass search that ends at steps of 1e-5.
/// Assumes: white residuals, in the contrast alone. Refuses when: not one equation can be answered.
/// Cost: some two hundred fits, spread over `threads`; the result does not depend on them.
Result<DeadZoneEstimate> EstimateDeadZone(const PreparedDataset& dataset,
                                          const RegressionOptions& options,
                                          const ExcitationLimits& limits, std::size_t threads);

}  // namespace telltale
