#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "telltale/core/diagnosis/delays/recording_delays.hpp"
#include "telltale/core/diagnosis/diagnosis.hpp"
#include "telltale/core/effects/effect.hpp"

namespace telltale {

/// The effect that a longer delay of a channel is. It has one parameter, in s.
const Effect& EffectOf(DelayedChannel channel);

/// The delay of a recording beside those of nominal days: a random-effects model, whose scatter
/// between days has a half-normal prior, integrated numerically; docs/concepts/diagnosis.md (120),
/// (121). Requires: at least one nominal day. Source: Higgins, Thompson and Spiegelhalter, "A
/// re-evaluation of random-effects meta-analysis", Journal of the Royal Statistical Society A 172
/// (2009).
DelayDifference DelayDifferenceOf(DelayedChannel channel, const DelayEstimate& recording,
                                  const std::vector<DelayEstimate>& nominal);

/// Of both channels, by the references that show their delays but `without`. None where the
/// recording does not show its own, or where fewer than kDiagnosis.delays.least_references do.
std::vector<DelayDifference> DelayDifferencesOf(const ComparedDelays& delays,
                                                std::optional<std::size_t> without = std::nullopt);

/// Whether the channel is later than on nominal days by the odds that make a gap material. One that
/// is earlier is no effect of the library.
bool IsLate(const DelayDifference& difference);

}  // namespace telltale
