#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "telltale/core/diagnosis/diagnosis.hpp"
#include "telltale/core/diagnosis/hypotheses/diagnosis_problem.hpp"
#include "telltale/core/diagnosis/report/conclusion.hpp"
#include "telltale/core/diagnosis/report/horizon_gap.hpp"

namespace telltale {

/// Names the delays of channels that are late, IsLate(), whose effects the library has: where free
/// runs show no gap or leave one undecided, where a gap has no certain cause and those delays
/// explain it, and in place of a cause that is less likely and has no gap to explain. Late commands
/// are indistinguishable from a thrust that follows slowly. A delay that is not fitted to the free
/// runs explains them by no chance. A late fix on a straight course is a start farther back, which
/// a free run does not show.
void ConcludeFromDelays(const std::vector<DelayDifference>& delays,
                        std::span<const Effect* const> library, const DiagnosisProblem& problem,
                        const HorizonErrors& main, std::uint64_t seed, Conclusion& conclusion);

/// How the late channels are known, in a sentence; empty where none is late.
std::string DescribeLateChannels(const std::vector<DelayDifference>& delays);

}  // namespace telltale
