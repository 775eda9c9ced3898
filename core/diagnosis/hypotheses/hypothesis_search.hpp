#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "telltale/core/diagnosis/hypotheses/diagnosis_problem.hpp"
#include "telltale/core/diagnosis/hypotheses/effect_fit.hpp"

namespace telltale {

/// What explains a recording's errors, single effects by score, then the best that act together.
struct Hypotheses {
  std::vector<EffectFit> singles;   ///< every effect that was fitted, the likeliest first
  std::vector<EffectFit> combined;  ///< combinations that are worth their second or third effect,
                                    ///< the likeliest first
};

/// Scores are in comparison with nominal days: what an effect seems to explain of those, the most
/// of any, and half as much again, is taken back.
///
/// Screens every effect by the score test, fits the most promising in full, then adds a second and
/// a third effect where the evidence asks for it and they are of different classes; what a
/// combination can do without is dropped again. `tell` is called with the share done.
Hypotheses Search(const DiagnosisProblem& problem, std::span<const Effect* const> library,
                  std::size_t most_effects, std::size_t threads,
                  const std::function<void(double)>& tell);

/// Nats by which the better of two explanations would win if it were the truth: below
/// kSeparableLogEvidence this recording cannot tell them apart.
double Distance(const EffectFit& one, const EffectFit& other, const ResidualMetric& metric);
inline constexpr double kSeparableLogEvidence = 3.0;

/// -2 ln of how much likelier the first is than the second has to be before it counts as found.
inline constexpr double kScoreToAddEffect = 12.0;

}  // namespace telltale
