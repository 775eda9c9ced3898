#pragma once

#include <vector>

#include "telltale/core/diagnosis/diagnosis.hpp"
#include "telltale/core/diagnosis/healthy.hpp"
#include "telltale/core/diagnosis/ranking.hpp"

namespace telltale {

/// Which manoeuvres of the catalogue would tell a tied explanation from those that predict the
/// same on this recording, best first: the nats between what they predict of two minutes of each,
/// docs/diagnosis.md (96). None where nothing is tied.
std::vector<SeparationAdvice> AdviseSeparation(const RankedFit& tied, const Healthy& healthy,
                                               double sampling_period_s);

/// What would settle it where no manoeuvre is promised to: sensors.
std::string SensorThatSettles(const RankedFit& tied);

}  // namespace telltale
