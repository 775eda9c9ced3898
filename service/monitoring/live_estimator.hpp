#pragma once

#include <optional>

#include "telltale/core/data/samples.hpp"
#include "telltale/core/uncertainty/live_bounds.hpp"
#include "telltale/core/vessel/vehicle.hpp"
#include "telltale/idl/codec/messages/quality.hpp"

namespace telltale {

/// The live bounds of one vehicle, fed with prepared rows as they become final: the newest rows of
/// a recording still change as their filter gets to know what follows, and are left for later.
/// Static structure, propeller parameterization. A clock that was set back starts all anew.
/// Not thread safe.
class LiveEstimator {
 public:
  /// Whether there is so much new up to `end_s` that taking it in is worth the while.
  bool IsDue(double end_s) const;

  /// Takes in the rows of a window's newest recording that it has not seen.
  void Update(const Recording& recording, const Vehicle& vehicle);

  /// One estimate with its error bar a coefficient that the rows held determine, or nothing.
  std::vector<IndicativeCoefficient> Estimates() const;

  std::size_t rows() const { return rows_; }

 private:
  void AddSettledRows(const PreparedDataset& dataset);

  std::optional<double> sampling_period_s_;
  std::optional<LiveBounds> bounds_;
  double fed_to_s_ = 0.0;   ///< the newest row taken in
  double seen_to_s_ = 0.0;  ///< the newest sample looked at
  std::size_t rows_ = 0;
};

}  // namespace telltale
