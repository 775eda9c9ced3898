#include "diagnosis/ranking.hpp"

#include <algorithm>
#include <cmath>

namespace telltale {
namespace {

// Scores are tempered, exp(-S / 2T): errors are not quite as normal, nor models as exact, as
// evidence has them. Calibrated on development cases, docs/blind.md.
constexpr double kTemperature = 4.0;
// A recording is called unwell for a score below the negative of this.
constexpr double kMaterialEvidence = 100.0;
// What an explanation leaves is as on a healthy day below the first (of ln), and no healthy
// development case left more than the second.
constexpr double kLikeHealth = 0.6;
constexpr double kNeverInHealth = 0.9;
// An explanation has to take away half of what a Judge has against the recording, or else leave it
// like a healthy one, and close the gap: at this share of both it is as doubtful as not.
constexpr double kFullyTakenAway = 0.5;
constexpr double kHalfDoubtedAt = 0.45;
constexpr double kSharpness = 10.0;
constexpr double kExplained = 0.7;

double Logistic(double x) {
  return 1.0 / (1.0 + std::exp(-x));
}

std::vector<std::string> NamesOf(const EffectFit& fit) {
  std::vector<std::string> names;
  for (const ModelledEffect& modelled : fit.effects) names.emplace_back(modelled.effect->Name());
  return names;
}

/// Share of what a Judge has against the recording that an explanation takes away.
double TakenAway(const Remainder& remainder) {
  const double before = std::exp(remainder.log_before - remainder.healthy_mean) - 1.0;
  const double after = std::exp(remainder.log_leftover - remainder.healthy_mean) - 1.0;
  return before > 0.0 ? 1.0 - after / before : 1.0;
}

/// How much there is to doubt an explanation by what it leaves.
double DoubtOf(const Remainder& remainder) {
  const bool like_health = remainder.log_leftover - remainder.healthy_mean < kLikeHealth;
  double explained = like_health ? 1.0 : TakenAway(remainder) / kFullyTakenAway;
  if (remainder.closure) explained = std::min(explained, *remainder.closure);
  return Logistic(kSharpness * (kHalfDoubtedAt - explained));
}

}  // namespace

std::vector<std::string> RankedFit::Indistinguishable() const {
  const std::vector<std::string> own = NamesOf(fit);
  std::vector<std::string> others;
  for (const EffectFit& other : alike) {
    for (const std::string& name : NamesOf(other)) {
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
  const auto weight = [&](double score) {
    return std::exp(-(score - best) / (2.0 * kTemperature));
  };
  Ranking ranking;
  ranking.nothing = weight(0.0);
  double total = ranking.nothing;
  for (const EffectFit& fit : all) {
    const double own = weight(fit.score);
    total += own;
    const auto alike =
        std::find_if(ranking.fits.begin(), ranking.fits.end(), [&](const RankedFit& r) {
          return r.fit.effects.size() == fit.effects.size() &&
                 Distance(r.fit, fit, judge) < kClassDistance;
        });
    if (alike == ranking.fits.end()) {
      ranking.fits.push_back({fit, own, {}});
      continue;
    }
    alike->probability += own;
    alike->alike.push_back(fit);
  }
  ranking.unknown = DoubtOf(remainder);
  const double known = (1.0 - ranking.unknown) / total;
  ranking.nothing *= known;
  for (RankedFit& ranked : ranking.fits) ranked.probability *= known;
  return ranking;
}

bool IsMaterial(double squared_gap, double squared_limit, double best_score,
                const Remainder& remainder) {
  return squared_gap > squared_limit || best_score < -kMaterialEvidence ||
         remainder.log_before - remainder.healthy_mean > kNeverInHealth;
}

Verdict VerdictOf(const Ranking& ranking, const Remainder& remainder, bool material,
                  bool conclusive) {
  if (!material) return conclusive ? Verdict::kNoMaterialGap : Verdict::kInsufficientData;
  if (ranking.fits.empty() || ranking.unknown > 0.5) return Verdict::kUnknownCause;
  if (!remainder.closure || *remainder.closure >= kExplained) return Verdict::kExplained;
  return Verdict::kPartlyExplained;
}

}  // namespace telltale
