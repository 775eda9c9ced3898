#pragma once

#include <cstdint>
#include <vector>

#include "telltale/core/diagnosis/diagnosis.hpp"
#include "telltale/core/diagnosis/report/conclusion.hpp"
#include "telltale/core/diagnosis/report/horizon_gap.hpp"

namespace telltale {

/// The causes that a report lists, most probable first: the ranked hypotheses, and the unknown
/// cause, which has no effects. Effects of the first cause that act together get Shapley shares of
/// what they explain at the main horizon.
std::vector<Cause> CausesOf(const Conclusion& conclusion, const DiagnosisProblem& problem,
                            const HorizonErrors& main, std::uint64_t seed);

}  // namespace telltale
