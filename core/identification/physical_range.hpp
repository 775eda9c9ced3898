#pragma once

#include "telltale/core/identification/physical_model.hpp"

namespace telltale {

/// Where the parameters of a physical model may lie: the range of their priors, for a hull twice as
/// long as its propellers are apart, with the estimates in it and, where the range follows the
/// length of the hull, the intervals. docs/concepts/physical-model.md.
struct PhysicalRange {
  FossenVector least;
  FossenVector greatest;

  /// The parameters moved into the range, and to where M is positive definite.
  FossenVector Within(const FossenVector& parameters) const;
};

PhysicalRange RangeOf(const PhysicalModel& model);

}  // namespace telltale
