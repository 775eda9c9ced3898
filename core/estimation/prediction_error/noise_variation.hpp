#pragma once

#include <utility>
#include <vector>

#include "telltale/core/estimation/prediction_error/covariance_filter.hpp"
#include "telltale/core/estimation/prediction_error/filter_transition.hpp"
#include "telltale/core/estimation/prediction_error/innovation.hpp"

namespace telltale {

/// A filter of the same boat under another noise, which runs beside a first one on the transitions
/// of that: its state is that of the first one and a deviation, which follows linearly. It takes
/// half the time of a filter of its own, and is that filter where motions are small enough for
/// their equations to be linear.
class NoiseVariation {
 public:
  explicit NoiseVariation(const CovarianceFilter& start) : filter_(start) {}

  /// After a step of the first filter from the state `before`.
  void Step(const FilterTransition& transition, const FilterState& before);

  /// Where the first filter takes the reading with its own gain.
  void Take(const ScalarReading& reading, const FilterGain& gain, double time_s);

  std::vector<Innovation> TakeInnovations() { return std::move(innovations_); }

 private:
  CovarianceFilter filter_;
  FilterState deviation_ = FilterState::Zero();  ///< of its state from that of the first filter
  std::vector<Innovation> innovations_;
};

}  // namespace telltale
