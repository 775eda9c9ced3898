#include "telltale/core/diagnosis/hypotheses/ranking.hpp"

#include <algorithm>
#include <cmath>

namespace telltale {
namespace {

// Chosen on development cases, docs/validation/blind-checks.md.
// A recording is called unwell for a score below the negative of this,
constexpr double kMaterialScore = 8.0;
// or for what a ResidualMetric has against it, as ln of a share of what it has against nominal
// ones.
constexpr double kMaterialLogLackOfFit = 0.9;
// Times the limit: what an upper bound may be of a gap that is no more than health.
constexpr double kEquivalenceFactor = 2.0;
// The logarithm of the odds that it is something else: so much a unit of ln of what is left, with
// an even chance at this much; this much sooner for each further effect, as several mend between
// them what none of them is, and for each unit that could be learnt from the rest. By the
// logarithmic score, of explanations by true effects and of those by others where the true one was
// left out, the latter a quarter of all.
constexpr double kDoubtSlope = 2.8;
constexpr double kDoubtMidpoint = -0.2;
constexpr double kDoubtPerExtraEffect = 0.7;
constexpr double kDoubtPerPredictable = 4.0;
constexpr double kExplained = 0.7;  // of the gap
// Odds of nine to one: below them a cause may be likely, and is not named for sure.
constexpr double kNamingProbability = 0.9;

double Logistic(double x) {
  return 1.0 / (1.0 + std::exp(-x));
}

/// Share of the excess that an explanation may leave unseen: of the nats that speak for it, as many
/// as do not tell two explanations apart. What little speaks for stands in for much.
double UnseenShare(const EffectFit& best) {
  return kSeparableLogEvidence / (kSeparableLogEvidence + 0.5 * std::max(-best.score, 0.0));
}

/// Probability that it is something else, by what the likeliest explanation leaves and how far it
/// had to be bent: strain is -ln of how likely such shapes are where the explanation is right.
double UnknownProbability(const LackOfFit& lack_of_fit, const EffectFit& best) {
  const double excess = lack_of_fit.after - lack_of_fit.nominal;
  const double before = std::max(lack_of_fit.before - lack_of_fit.nominal, excess);
  const double unseen = UnseenShare(best);
  const double share = before > 0.0 ? std::max(excess / before, unseen) : unseen;
  const double left = std::log(share) + std::log(lack_of_fit.after / lack_of_fit.nominal);
  const double penalty = kDoubtPerExtraEffect * static_cast<double>(best.effects.size() - 1) +
                         kDoubtPerPredictable * std::max(lack_of_fit.predictable, 0.0);
  return Logistic(kDoubtSlope * (left - kDoubtMidpoint + penalty) + best.NegativeLogPrior());
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

Ranking Rank(const Hypotheses& hypotheses, const ResidualMetric& metric,
             const LackOfFit& lack_of_fit) {
  std::vector<EffectFit> all = hypotheses.combined;
  all.insert(all.end(), hypotheses.singles.begin(), hypotheses.singles.end());
  std::sort(all.begin(), all.end(),
            [](const EffectFit& a, const EffectFit& b) { return a.score < b.score; });
  const double best = std::min(all.front().score, 0.0);
  const auto weight = [&](double score) { return std::exp(-0.5 * (score - best)); };
  Ranking ranking;
  ranking.no_effect = weight(0.0);
  double total = ranking.no_effect;
  for (const EffectFit& fit : all) {
    const double own = weight(fit.score);
    total += own;
    const auto equivalent =
        std::find_if(ranking.fits.begin(), ranking.fits.end(), [&](const RankedHypothesis& r) {
          return fit.score < -kMaterialScore && r.fit.effects.size() == fit.effects.size() &&
                 Distance(r.fit, fit, metric) < kSeparableLogEvidence;
        });
    if (equivalent == ranking.fits.end()) {
      ranking.fits.push_back({fit, own, {}});
      continue;
    }
    equivalent->probability += own;
    equivalent->equivalent.push_back(fit);
  }
  ranking.unknown = UnknownProbability(lack_of_fit, all.front());
  const double known = (1.0 - ranking.unknown) / total;
  ranking.no_effect *= known;
  for (RankedHypothesis& ranked : ranking.fits) ranked.probability *= known;
  return ranking;
}

GapAssessment AssessGap(double squared_gap, double upper_squared_gap, double squared_limit,
                        double best_score, const LackOfFit& lack_of_fit) {
  const double beyond = std::log(lack_of_fit.before / lack_of_fit.nominal);
  if (best_score < -kMaterialScore || beyond > kMaterialLogLackOfFit)
    return GapAssessment::kMaterial;
  const bool small =
      squared_gap <= squared_limit && upper_squared_gap <= kEquivalenceFactor * squared_limit;
  return small ? GapAssessment::kWithinNominal : GapAssessment::kUndecided;
}

bool IsLikely(GapAssessment assessment, const Ranking& ranking) {
  return assessment == GapAssessment::kMaterial && !ranking.fits.empty() && ranking.unknown <= 0.5;
}

Verdict VerdictOf(GapAssessment assessment, const Ranking& ranking,
                  const std::optional<ExcessExplained>& excess_explained) {
  if (assessment == GapAssessment::kWithinNominal) return Verdict::kNoMaterialGap;
  if (assessment == GapAssessment::kUndecided) return Verdict::kInsufficientData;
  const bool named_outright =
      !ranking.fits.empty() && ranking.fits.front().probability >= kNamingProbability;
  if (!named_outright) return Verdict::kUnknownCause;
  if (!excess_explained || excess_explained->share >= kExplained) return Verdict::kExplained;
  return Verdict::kPartlyExplained;
}

}  // namespace telltale
