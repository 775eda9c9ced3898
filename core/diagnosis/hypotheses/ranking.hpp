#pragma once

#include <optional>
#include <string>
#include <vector>

#include "telltale/core/diagnosis/diagnosis.hpp"
#include "telltale/core/diagnosis/hypotheses/hypothesis_search.hpp"
#include "telltale/core/diagnosis/hypotheses/lack_of_fit.hpp"

namespace telltale {

/// A hypothesis with its probability, docs/concepts/diagnosis.md (91).
struct RankedHypothesis {
  EffectFit fit;
  double probability = 0.0;           ///< of the fit and its equivalents together
  std::vector<EffectFit> equivalent;  ///< less probable ones that this recording cannot separate

  /// Names of the effects of the equivalents that the fit itself does not have.
  std::vector<std::string> Indistinguishable() const;
};

/// Probabilities of all hypotheses; they add up to one.
struct Ranking {
  std::vector<RankedHypothesis> fits;  ///< most probable first
  double no_effect = 0.0;              ///< probability that no effect acts
  double unknown = 0.0;                ///< probability of an effect that the library lacks
  std::vector<OddsTerm> unknown_odds;  ///< what makes it so
};

/// Probabilities proportional to exp(-score / 2) (91), less the probability of an unknown effect,
/// which is logistic in what the likeliest hypothesis leaves unexplained. Hypotheses of as many
/// effects within kDiagnosis.search.separable_nats of one another form one class: its likeliest
/// member stands for all and has their probability. Requires: at least one single hypothesis.
Ranking Rank(const Hypotheses& hypotheses, const ResidualMetric& metric,
             const LackOfFit& lack_of_fit);

/// What a hypothesis is, besides what it leaves.
struct HypothesisTraits {
  double score = 0.0;
  double negative_log_prior = 0.0;  ///< of its shape parameters
  std::size_t faults = 1;           ///< of the boat; without any it is weather alone
  /// Whether one of its effects drifts, as a current does; whether one is stochastic; whether one
  /// is intermittent. What is allowed for hides what else there is.
  bool drifts = false;
  bool is_stochastic = false;
  bool is_intermittent = false;
};

HypothesisTraits TraitsOf(const EffectFit& fit);

/// Probability that the cause is another than such a hypothesis. It grows with what the hypothesis
/// leaves, with what is predictable in its errors, with its negative log prior, with every fault
/// after the first, and where it allows for what varies.
double UnknownProbability(const LackOfFit& lack_of_fit, const HypothesisTraits& hypothesis);

/// Its log odds, term by term.
std::vector<OddsTerm> UnknownOdds(const LackOfFit& lack_of_fit, const HypothesisTraits& hypothesis);

/// Whether a cause of this probability is named.
bool IsCertain(double probability);

/// Whether a recording shows a gap, before any cause is named.
enum class GapAssessment {
  kWithinNominal,  ///< the upper bound of the gap is within what nominal recordings show
  kUndecided,      ///< the gap may be larger, but no effect explains it and weather or a short
                   ///< recording may account for it
  kMaterial,       ///< an effect explains the gap, or the lack of fit is beyond that of references
};

/// `squared_gap`: G^2; `upper_squared_gap`: its upper 95 % bound; `squared_limit`: what 95 % of
/// nominal recordings stay below; `best_score`: of the likeliest hypothesis.
GapAssessment AssessGap(double squared_gap, double upper_squared_gap, double squared_limit,
                        double best_score, const LackOfFit& lack_of_fit);

/// Whether the hypothesis of the lowest score is the most probable cause, the unknown one included.
/// Then it leads the report, which shows its figures, and the model is identified again with it.
bool IsLikely(GapAssessment assessment, const Ranking& ranking);

/// The verdict. A cause is named from odds of nine to one on; below them the cause is unknown.
/// `excess_explained` is cross-validated; none where there is no gap.
Verdict VerdictOf(GapAssessment assessment, const Ranking& ranking,
                  const std::optional<ExcessExplained>& excess_explained);

}  // namespace telltale
