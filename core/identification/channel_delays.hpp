#pragma once

#include <cstddef>
#include <optional>

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/samples.hpp"
#include "telltale/core/identification/coefficient.hpp"
#include "telltale/core/identification/progress.hpp"
#include "telltale/core/vessel/vehicle.hpp"

namespace telltale {

/// How the stamps of commands and fixes stand to the clock of the headings, with bounds, and the
/// part of the recording that shows it. Units: seconds. A status of kPrior: the recording cannot
/// tell, and the bounds are those expected of any boat.
struct ChannelDelays {
  Coefficient commands;  ///< how long after their stamps they act
  Coefficient fixes;     ///< how long before their stamps the boat was there
  double start_s = 0.0;
  double end_s = 0.0;
  std::optional<Refusal> warning;  ///< why the bounds may not hold: the fit did not converge
};

/// The longest part of a recording that delays are estimated from.
inline constexpr double kLongestDelayPartS = 600.0;

/// The delays of the physical form as Identify() has them, from the part of the recording in which
/// the commands change the most, all of it where it is no longer than kLongestDelayPartS. A part
/// bounds time and memory; delays do not change with the length of a recording.
/// Refuses when: Identify() of Structure::kFossen does.
/// Source: docs/concepts/physical-model.md (108), (109).
Result<ChannelDelays> EstimateChannelDelays(const Recording& recording, const Vehicle& vehicle,
                                            std::size_t threads, const Progress& progress = {});

}  // namespace telltale
