#pragma once

#include <optional>
#include <string>
#include <vector>

#include "telltale/core/diagnosis/diagnosis.hpp"
#include "telltale/core/diagnosis/remainder.hpp"
#include "telltale/core/diagnosis/search.hpp"

namespace telltale {

/// An explanation and how probable it is, docs/diagnosis.md (91).
struct RankedFit {
  EffectFit fit;
  double probability = 0.0;
  std::vector<EffectFit> alike;  ///< less probable ones that predict the same

  /// Effects that would do as well in its place.
  std::vector<std::string> Indistinguishable() const;
};

struct Ranking {
  std::vector<RankedFit> fits;  ///< most probable first
  double nothing = 0.0;         ///< probability that all is well
  double unknown = 0.0;         ///< that it is something the library lacks
};

/// Weighs explanations by their scores, and against something unknown by what they leave.
/// Those that predict the same, to within kClassDistance, are one class: its likeliest member
/// stands for all and has their probability.
Ranking Rank(const Explanations& explanations, const Judge& judge, const Remainder& remainder);

/// What there is to say about a gap before looking for whose fault it is.
enum class Gate {
  kWithinHealth,  ///< equivalent: even its upper bound is hardly beyond what healthy days do
  kUndecided,     ///< larger, but weather and what references leave open may account for it, or too
                  ///< short a recording to bound it
  kMaterial,      ///< more than health can be taken for: something explains it, or nothing does
};

/// `squared_gap` with its upper 95 % bound, `squared_limit` that 95 % of healthy recordings stay
/// below.
Gate GateOf(double squared_gap, double upper_squared_gap, double squared_limit, double best_score,
            const Remainder& remainder);

/// Whether the likeliest explanation is worth following up: a better model, how far it closes.
bool IsLikely(Gate gate, const Ranking& ranking);

/// A likely cause is named for sure from odds of nine to one on; below them the cause is unknown.
/// `closure`: held out; none where there is no gap.
Verdict VerdictOf(Gate gate, const Ranking& ranking, const std::optional<Closure>& closure);

}  // namespace telltale
