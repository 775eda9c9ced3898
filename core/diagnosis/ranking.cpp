#include "telltale/core/diagnosis/ranking.hpp"

#include <algorithm>
#include <cmath>

namespace telltale {
namespace {

// Chosen on development cases, docs/blind.md.
// A recording is called unwell for a score below the negative of this,
constexpr double kMaterialEvidence = 8.0;
// or for what a Judge has against it, as ln of a share of what it has against healthy ones.
constexpr double kNeverInHealth = 0.9;
// Times the limit: what an upper bound may be of a gap that is no more than health.
constexpr double kEquivalent = 2.0;
// The logarithm of the odds that it is something else: so much a unit of ln of what is left, with
// an even chance at this much; this much sooner for each further effect, as several mend between
// them what none of them is, and for each unit that could be learnt from the rest. By the
// logarithmic score, of explanations by true effects and of those by others where the true one was
// left out, the latter a quarter of all.
constexpr double kSharpness = 2.8;
constexpr double kEvenAt = -0.2;
constexpr double kSoonerEach = 0.7;
constexpr double kSoonerLearnable = 4.0;
constexpr double kExplained = 0.7;  // of the gap
// Odds of nine to one: below them a cause may be likely, and is not named for sure.
constexpr double kSure = 0.9;

double Logistic(double x) {
  return 1.0 / (1.0 + std::exp(-x));
}

/// Share of the excess that an explanation may leave unseen: of the nats that speak for it, as many
/// as do not tell two explanations apart. What little speaks for stands in for much.
double UnseenShare(const EffectFit& best) {
  return kClassDistance / (kClassDistance + 0.5 * std::max(-best.score, 0.0));
}

/// Probability that it is something else, by what the likeliest explanation leaves and how far it
/// had to be bent: strain is -ln of how likely such shapes are where the explanation is right.
double DoubtOf(const Remainder& remainder, const EffectFit& best) {
  const double excess = remainder.after - remainder.healthy;
  const double before = std::max(remainder.before - remainder.healthy, excess);
  const double unseen = UnseenShare(best);
  const double share = before > 0.0 ? std::max(excess / before, unseen) : unseen;
  const double left = std::log(share) + std::log(remainder.after / remainder.healthy);
  const double sooner = kSoonerEach * static_cast<double>(best.effects.size() - 1) +
                        kSoonerLearnable * std::max(remainder.learnable, 0.0);
  return Logistic(kSharpness * (left - kEvenAt + sooner) + best.Strain());
}

}  // namespace

std::vector<std::string> RankedFit::Indistinguishable() const {
  const std::vector<std::string> own = fit.Names();
  std::vector<std::string> others;
  for (const EffectFit& other : alike) {
    for (const std::string& name : other.Names()) {
      const auto listed = [&](const std::vector<std::string>& names) {
        return std::find(names.begin(), names.end(), name) != names.end();
      };
      if (!listed(own) && !listed(others)) others.push_back(name);
    }
  }
  return others;
}

Ranking Rank(const Explanations& explanations, const Judge& judge, const Remainder& remainder) {
  std::vector<EffectFit> all = explanations.together;
  all.insert(all.end(), explanations.singles.begin(), explanations.singles.end());
  std::sort(all.begin(), all.end(),
            [](const EffectFit& a, const EffectFit& b) { return a.score < b.score; });
  const double best = std::min(all.front().score, 0.0);
  const auto weight = [&](double score) { return std::exp(-0.5 * (score - best)); };
  Ranking ranking;
  ranking.nothing = weight(0.0);
  double total = ranking.nothing;
  for (const EffectFit& fit : all) {
    const double own = weight(fit.score);
    total += own;
    const auto alike =
        std::find_if(ranking.fits.begin(), ranking.fits.end(), [&](const RankedFit& r) {
          return fit.score < -kMaterialEvidence && r.fit.effects.size() == fit.effects.size() &&
                 Distance(r.fit, fit, judge) < kClassDistance;
        });
    if (alike == ranking.fits.end()) {
      ranking.fits.push_back({fit, own, {}});
      continue;
    }
    alike->probability += own;
    alike->alike.push_back(fit);
  }
  ranking.unknown = DoubtOf(remainder, all.front());
  const double known = (1.0 - ranking.unknown) / total;
  ranking.nothing *= known;
  for (RankedFit& ranked : ranking.fits) ranked.probability *= known;
  return ranking;
}

Gate GateOf(double squared_gap, double upper_squared_gap, double squared_limit, double best_score,
            const Remainder& remainder) {
  const double beyond = std::log(remainder.before / remainder.healthy);
  if (best_score < -kMaterialEvidence || beyond > kNeverInHealth) return Gate::kMaterial;
  const bool small =
      squared_gap <= squared_limit && upper_squared_gap <= kEquivalent * squared_limit;
  return small ? Gate::kWithinHealth : Gate::kUndecided;
}

bool IsLikely(Gate gate, const Ranking& ranking) {
  return gate == Gate::kMaterial && !ranking.fits.empty() && ranking.unknown <= 0.5;
}

Verdict VerdictOf(Gate gate, const Ranking& ranking, const std::optional<Closure>& closure) {
  if (gate == Gate::kWithinHealth) return Verdict::kNoMaterialGap;
  if (gate == Gate::kUndecided) return Verdict::kInsufficientData;
  const bool sure = !ranking.fits.empty() && ranking.fits.front().probability >= kSure;
  if (!sure) return Verdict::kUnknownCause;
  if (!closure || closure->share >= kExplained) return Verdict::kExplained;
  return Verdict::kPartlyExplained;
}

}  // namespace telltale
