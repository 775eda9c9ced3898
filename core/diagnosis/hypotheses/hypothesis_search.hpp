#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <span>
#include <vector>

#include "telltale/core/diagnosis/hypotheses/diagnosis_problem.hpp"
#include "telltale/core/diagnosis/hypotheses/effect_fit.hpp"

namespace telltale {

/// Hypotheses that explain a recording's errors, each list by score, the likeliest first.
struct Hypotheses {
  std::vector<EffectFit> singles;   ///< every single effect that was fitted
  std::vector<EffectFit> combined;  ///< of two or three effects, where the evidence asks for each
  std::map<const Effect*, double> nominal_gains;  ///< of every effect, NominalGains
};

/// By how much the score of `to` has to fall where this effect is added.
double ScoreToAdd(const Effect& effect, const EffectFit& to);

/// The hypothesis with the lowest score. Requires: at least one single hypothesis.
const EffectFit& BestHypothesis(const Hypotheses& hypotheses);

/// Those of `singles`, best first, that another effect is added to: the kDiagnosis.search
/// .seed_hypotheses best that are not stochastic, and the stochastic ones with evidence.
std::vector<EffectFit> SeedsOf(const std::vector<EffectFit>& singles);

/// Screens every effect by the score test, fits the most promising in full, then adds a second and
/// a third effect where the score falls by ScoreToAdd, and the effects are separable. An effect
/// that a combination does not need is removed again, and each is exchanged for others where
/// nothing can be added. Every score is raised by the NominalGains of its effects.
/// `report_progress` gets the share done; it is called by one thread at a time. `known`:
/// hypotheses of nearly the same problem. Single effects start from their values and from nowhere
/// else, and only what they give evidence of, or the score test promises, is fitted.
Hypotheses Search(const DiagnosisProblem& problem, std::span<const Effect* const> library,
                  std::size_t most_effects, std::size_t threads,
                  const std::function<void(double)>& report_progress, const Hypotheses& known = {});

/// Expected log evidence, in nats, of the better of two hypotheses over the other if it is true.
/// Below kDiagnosis.search.separable_nats this recording does not separate them. Of two that
/// predict alike, one with scatter from window to window, it is what their own evidence differs by.
/// Infinite where their stochastic effects differ.
double Distance(const EffectFit& one, const EffectFit& other, const ResidualMetric& metric);

}  // namespace telltale
