#pragma once

#include <optional>
#include <string>
#include <vector>

#include "telltale/core/diagnosis/hypotheses/hypothesis_search.hpp"
#include "telltale/core/diagnosis/hypotheses/lack_of_fit.hpp"
#include "telltale/core/diagnosis/report/diagnosis.hpp"

namespace telltale {

/// An explanation and how probable it is, docs/concepts/diagnosis.md (91).
struct RankedHypothesis {
  EffectFit fit;
  double probability = 0.0;
  std::vector<EffectFit> equivalent;  ///< less probable ones that predict the same

  /// Effects that would do as well in its place.
  std::vector<std::string> Indistinguishable() const;
};

struct Ranking {
  std::vector<RankedHypothesis> fits;  ///< most probable first
  double no_effect = 0.0;              ///< probability that all is well
  double unknown = 0.0;                ///< that it is something the library lacks
};

/// Weighs explanations by their scores, and against something unknown by what they leave.
/// Those that predict the same, to within kSeparableLogEvidence, are one class: its likeliest
/// member stands for all and has their probability.
Ranking Rank(const Hypotheses& hypotheses, const ResidualMetric& metric,
             const LackOfFit& lack_of_fit);

/// What there is to say about a gap before looking for whose fault it is.
enum class GapAssessment {
  kWithinNominal,  ///< equivalent: even its upper bound is hardly beyond what nominal days do
  kUndecided,  ///< larger, but weather and what references leave open may account for it, or too
               ///< short a recording to bound it
  kMaterial,   ///< more than health can be taken for: something explains it, or nothing does
};

/// `squared_gap` with its upper 95 % bound, `squared_limit` that 95 % of nominal recordings stay
/// below.
GapAssessment AssessGap(double squared_gap, double upper_squared_gap, double squared_limit,
                        double best_score, const LackOfFit& lack_of_fit);

/// Whether the likeliest explanation is worth following up: a better model, how far it closes.
bool IsLikely(GapAssessment assessment, const Ranking& ranking);

/// A likely cause is named for sure from odds of nine to one on; below them the cause is unknown.
/// `closure`: held out; none where there is no gap.
Verdict VerdictOf(GapAssessment assessment, const Ranking& ranking,
                  const std::optional<ExcessExplained>& excess_explained);

}  // namespace telltale
