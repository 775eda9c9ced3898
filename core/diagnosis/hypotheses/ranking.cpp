#include "telltale/core/diagnosis/hypotheses/ranking.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "telltale/core/diagnosis/diagnosis_constants.hpp"

namespace telltale {
namespace {

constexpr RankingConstants kRanking = kDiagnosis.ranking;

double Logistic(double x) {
  return 1.0 / (1.0 + std::exp(-x));
}

/// Share of the excess that a hypothesis may leave without notice: the nats that do not separate
/// two hypotheses over those and the hypothesis' own.
double UnresolvedShare(double score) {
  constexpr double kSeparable = kDiagnosis.search.separable_nats;
  return kSeparable / (kSeparable + 0.5 * std::max(-score, 0.0));
}

std::vector<EffectFit> ByScore(const Hypotheses& hypotheses) {
  std::vector<EffectFit> all = hypotheses.combined;
  all.insert(all.end(), hypotheses.singles.begin(), hypotheses.singles.end());
  std::sort(all.begin(), all.end(),
            [](const EffectFit& a, const EffectFit& b) { return a.score < b.score; });
  return all;
}

/// A regressor of the odds of an unknown cause and its weight.
struct Term {
  const char* name;
  double value;
  double weight;
  double LogOdds() const { return weight * value; }
};

std::array<Term, 10> UnknownTerms(const LackOfFit& lack_of_fit,
                                  const HypothesisTraits& hypothesis) {
  const double excess = lack_of_fit.after - lack_of_fit.nominal;
  const double before = std::max(lack_of_fit.before - lack_of_fit.nominal, excess);
  const double unresolved = UnresolvedShare(hypothesis.score);
  const double share = before > 0.0 ? std::max(excess / before, unresolved) : unresolved;
  const UnknownWeights& weights =
      hypothesis.faults == 0 ? kRanking.unknown_beside_weather : kRanking.unknown_beside_faults;
  const std::size_t further_faults = std::max<std::size_t>(hypothesis.faults, 1) - 1;
  const auto over_nominal = [&](double square) { return std::log(square / lack_of_fit.nominal); };
  return {{{"constant", 1.0, weights.intercept},
           {"log_unexplained_share", std::log(share), weights.per_log_share},
           {"log_misfit", over_nominal(lack_of_fit.after), weights.per_misfit},
           {"log_median_misfit", over_nominal(lack_of_fit.median), weights.per_median_misfit},
           {"predictable", std::max(lack_of_fit.predictable, 0.0), weights.per_predictable},
           {"improbable_shape", hypothesis.negative_log_prior, weights.per_negative_log_prior},
           {"further_faults", static_cast<double>(further_faults), weights.per_further_fault},
           {"drift", hypothesis.drifts ? 1.0 : 0.0, weights.of_drift},
           {"waves", hypothesis.is_stochastic ? 1.0 : 0.0, weights.of_waves},
           {"spells", hypothesis.is_intermittent ? 1.0 : 0.0, weights.of_intermittence}}};
}

/// Whether this recording separates neither hypothesis from the other.
bool AreEquivalent(const RankedHypothesis& ranked, const EffectFit& fit,
                   const ResidualMetric& metric) {
  return fit.score < -kRanking.material_score && ranked.fit.effects.size() == fit.effects.size() &&
         Distance(ranked.fit, fit, metric) < kDiagnosis.search.separable_nats;
}

}  // namespace

std::vector<std::string> RankedHypothesis::Indistinguishable() const {
  const std::vector<std::string> own = fit.Names();
  std::vector<std::string> others;
  for (const EffectFit& other : equivalent) {
    for (const std::string& name : other.Names()) {
      const auto listed = [&](const std::vector<std::string>& names) {
        return std::find(names.begin(), names.end(), name) != names.end();
      };
      if (!listed(own) && !listed(others)) others.push_back(name);
    }
  }
  return others;
}

HypothesisTraits TraitsOf(const EffectFit& fit) {
  HypothesisTraits traits{.score = fit.score,
                          .negative_log_prior = fit.NegativeLogPrior(),
                          .faults = fit.Faults(),
                          .is_stochastic = fit.Stochastic() != nullptr};
  for (const Effect* effect : fit.Effects()) {
    const EffectFacts& facts = effect->Facts();
    traits.drifts |= facts.drift_time_s > 0.0;
    traits.is_intermittent |= effect->IsIntermittent();
  }
  return traits;
}

double UnknownProbability(const LackOfFit& lack_of_fit, const HypothesisTraits& hypothesis) {
  double log_odds = 0.0;
  for (const Term& term : UnknownTerms(lack_of_fit, hypothesis)) log_odds += term.LogOdds();
  return Logistic(log_odds);
}

std::vector<OddsTerm> UnknownOdds(const LackOfFit& lack_of_fit,
                                  const HypothesisTraits& hypothesis) {
  std::vector<OddsTerm> odds;
  for (const Term& term : UnknownTerms(lack_of_fit, hypothesis)) {
    odds.push_back({term.name, term.value, term.LogOdds()});
  }
  return odds;
}

bool IsCertain(double probability) {
  return probability >= kRanking.naming_probability;
}

Ranking Rank(const Hypotheses& hypotheses, const ResidualMetric& metric,
             const LackOfFit& lack_of_fit) {
  const std::vector<EffectFit> all = ByScore(hypotheses);
  const double best = std::min(all.front().score, 0.0);
  const auto weight = [&](double score) { return std::exp(-0.5 * (score - best)); };
  Ranking ranking;
  ranking.no_effect = weight(0.0);
  double total = ranking.no_effect;
  for (const EffectFit& fit : all) {
    const double own = weight(fit.score);
    total += own;
    const auto equivalent = std::find_if(
        ranking.fits.begin(), ranking.fits.end(),
        [&](const RankedHypothesis& ranked) { return AreEquivalent(ranked, fit, metric); });
    if (equivalent == ranking.fits.end()) {
      ranking.fits.push_back({fit, own, {}});
      continue;
    }
    equivalent->probability += own;
    equivalent->equivalent.push_back(fit);
  }
  const HypothesisTraits likeliest = TraitsOf(all.front());
  ranking.unknown = UnknownProbability(lack_of_fit, likeliest);
  ranking.unknown_odds = UnknownOdds(lack_of_fit, likeliest);
  const double known = (1.0 - ranking.unknown) / total;
  ranking.no_effect *= known;
  for (RankedHypothesis& ranked : ranking.fits) ranked.probability *= known;
  return ranking;
}

GapAssessment AssessGap(double squared_gap, double upper_squared_gap, double squared_limit,
                        double best_score, const LackOfFit& lack_of_fit) {
  const double beyond = std::log(lack_of_fit.before / lack_of_fit.nominal);
  if (best_score < -kRanking.material_score || beyond > kRanking.material_log_lack_of_fit)
    return GapAssessment::kMaterial;
  const bool small = squared_gap <= squared_limit &&
                     upper_squared_gap <= kRanking.equivalence_factor * squared_limit;
  return small ? GapAssessment::kWithinNominal : GapAssessment::kUndecided;
}

bool IsLikely(GapAssessment assessment, const Ranking& ranking) {
  if (assessment != GapAssessment::kMaterial || ranking.fits.empty()) return false;
  const double probability = ranking.fits.front().probability;
  return probability >= ranking.unknown + ranking.no_effect &&
         std::all_of(ranking.fits.begin(), ranking.fits.end(), [&](const RankedHypothesis& other) {
           return other.probability <= probability;
         });
}

Verdict VerdictOf(GapAssessment assessment, const Ranking& ranking,
                  const std::optional<ExcessExplained>& excess_explained) {
  if (assessment == GapAssessment::kWithinNominal) return Verdict::kNoMaterialGap;
  if (assessment == GapAssessment::kUndecided) return Verdict::kInsufficientData;
  const bool is_named = !ranking.fits.empty() && IsCertain(ranking.fits.front().probability);
  if (!is_named) return Verdict::kUnknownCause;
  if (!excess_explained || excess_explained->share >= kRanking.explained_share)
    return Verdict::kExplained;
  return Verdict::kPartlyExplained;
}

}  // namespace telltale
