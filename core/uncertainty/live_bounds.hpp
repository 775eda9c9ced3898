#pragma once

#include <array>
#include <optional>
#include <vector>

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/regression/regression_problem.hpp"
#include "telltale/core/estimation/regression/sliding_regression.hpp"
#include "telltale/core/vessel/regressors.hpp"

namespace telltale {

/// The one-step regressions of one vehicle, kept up to date row by row: estimates with error bars
/// as a stream. Indicative only: they share the attenuation of one-step least squares by noisy
/// velocities (docs/concepts/model.md, Limits), remember residuals for a fixed number of lags, and
/// are not to be read as 95 % of anything. Static structure; rows enter the equations as in
/// BuildRegression. Cost of a row: O(lags p^2) an equation.
class LiveBounds {
 public:
  /// Requires: the static structure, a known parameterization, a positive sampling period, sliding
  /// options within their ranges.
  LiveBounds(const RegressionOptions& regression, double sampling_period_s,
             const SlidingOptions& sliding);

  /// The next row of the vehicle. A step other than one sampling period is a gap. Requires: times
  /// that rise.
  void Add(const PreparedRow& row);

  /// Coefficients in the order of Regressors(), continuous-time SI. Refuses when: no more rows than
  /// coefficients are held.
  Result<SlidingEstimate> Estimate(Equation equation) const;

 private:
  struct Stream {
    SlidingRegression regression;
    bool unbroken = false;  ///< the row before this one entered too
  };

  void AddTo(Equation equation, const PreparedRow& now, const PreparedRow& next);

  RegressionOptions options_;
  double sampling_period_s_;
  std::optional<PreparedRow> last_;
  std::vector<Stream> streams_;  // by IndexOf(equation)
};

}  // namespace telltale
