#pragma once

#include <optional>

#include "telltale/core/data/samples.hpp"
#include "telltale/core/uncertainty/live_bounds.hpp"
#include "telltale/core/vessel/vehicle.hpp"
#include "telltale/idl/codec/messages/quality.hpp"

namespace telltale {

/// Live estimates of one vehicle by recursive one-step least squares over its prepared rows: static
/// structure, propeller parameterization. A row counts once it is final: the newest rows of a
/// recording still change with the samples that follow them, because the filter is not causal.
/// A clock that goes back resets the estimator. Not thread safe.
class LiveEstimator {
 public:
  /// Whether a window that ends at `end_s` has enough new samples for an update: 5 s of them, or a
  /// clock that went back.
  bool IsDue(double end_s) const;

  /// How much of the end of a window that ends at `end_s` an update needs, seconds.
  double NeedsS(double end_s) const;

  /// Adds the final rows of a window's recording that are newer than those added before.
  void Update(const Recording& recording, const Vehicle& vehicle);

  /// The coefficients that the rows determine, with their standard errors.
  std::vector<IndicativeCoefficient> Estimates() const;

  std::size_t rows() const { return rows_; }

 private:
  void AddSettledRows(const PreparedDataset& dataset);

  std::optional<double> sampling_period_s_;
  std::optional<LiveBounds> bounds_;
  double fed_to_s_ = 0.0;   ///< time of the newest row added
  double seen_to_s_ = 0.0;  ///< time of the newest sample at the last update
  std::size_t rows_ = 0;
};

}  // namespace telltale
