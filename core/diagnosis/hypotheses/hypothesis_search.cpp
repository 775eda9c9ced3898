#include "telltale/core/diagnosis/hypotheses/hypothesis_search.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <mutex>

#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/base/parallel.hpp"
#include "telltale/core/diagnosis/hypotheses/stochastic_excitation.hpp"

namespace telltale {
namespace {

constexpr std::size_t kEffectsFittedInFull = 14;  // of the effects that the score test likes best
constexpr std::size_t kCandidatesPerSeed = 5;     // tried beside each promising first
constexpr std::size_t kSeedHypotheses = 2;
constexpr double kNominalGainFactor = 1.5;

bool Contains(const EffectFit& fit, const Effect* effect) {
  const auto effects = fit.Effects();
  return std::find(effects.begin(), effects.end(), effect) != effects.end();
}

/// What free runs do not tell apart by where they lead.
std::vector<const Effect*> StochasticEffectsIn(const EffectFit& fit) {
  std::vector<const Effect*> stochastic_effects = fit.Effects();
  std::erase_if(stochastic_effects, [](const Effect* effect) { return !effect->IsStochastic(); });
  return stochastic_effects;
}

bool HasLowerScore(const EffectFit& a, const EffectFit& b) {
  return a.score < b.score;
}

class HypothesisSearch {
 public:
  HypothesisSearch(const DiagnosisProblem& problem, std::span<const Effect* const> library,
                   std::size_t threads)
      : problem_(problem), library_(library), threads_(threads) {
    MeasureNominalGains();
  }

  std::vector<EffectFit> Singles(const std::function<void(double)>& tell) const {
    std::vector<const Effect*> moving;
    std::vector<EffectFit> fits;
    for (const Effect* effect : library_) {
      if (effect->IsStochastic()) {
        fits.push_back(FitStochastic(*effect, problem_.recording.errors));
      } else {
        moving.push_back(effect);
      }
    }
    const auto ranked = ByScoreTest(moving, problem_.recording.errors);
    std::vector<EffectFit> fitted(std::min(kEffectsFittedInFull, ranked.size()));
    std::mutex telling;
    std::size_t done = 0;
    ForEachIndex(fitted.size(), threads_, [&](std::size_t i) {
      const Effect* effect = ranked[i];
      fitted[i] = Fit({effect}, StartsOf(*effect, problem_.metric, problem_.recording.errors,
                                         problem_.recording, problem_.parameter_refs));
      const std::lock_guard lock(telling);
      tell(static_cast<double>(++done) / static_cast<double>(fitted.size()));
    });
    fits.insert(fits.end(), fitted.begin(), fitted.end());
    std::sort(fits.begin(), fits.end(), HasLowerScore);
    return fits;
  }

  /// The best fits of one effect more than `first` has.
  std::vector<EffectFit> WithOneMore(const EffectFit& first,
                                     const std::vector<EffectFit>& singles) const {
    std::vector<const Effect*> others;
    for (const Effect* effect : library_) {
      if (Contains(first, effect) || effect->IsStochastic()) continue;
      const auto single = std::find_if(singles.begin(), singles.end(), [&](const EffectFit& fit) {
        return fit.effects.front().effect == effect;
      });
      const bool collinear = single != singles.end() && first.effects.size() == 1 &&
                             Distance(first, *single, problem_.metric) < kSeparableLogEvidence;
      if (!collinear) others.push_back(effect);
    }
    const auto ranked = ByScoreTest(others, first.errors);
    std::vector<EffectFit> fitted(std::min(kCandidatesPerSeed, ranked.size()));
    ForEachIndex(fitted.size(), threads_, [&](std::size_t i) {
      // The linear guess: what else there is has been fitted already.
      const Eigen::VectorXd start = StartsOf(*ranked[i], problem_.metric, first.errors,
                                             problem_.recording, problem_.parameter_refs)
                                        .front();
      const Eigen::VectorXd values = first.Values();
      Eigen::VectorXd stacked(values.size() + start.size());
      stacked << values, start;
      auto effects = first.Effects();
      effects.push_back(ranked[i]);
      fitted[i] = Fit(effects, {stacked});
    });
    return fitted;
  }

  /// With what shakes the boat besides, where there is such a thing.
  EffectFit WithStochastic(const EffectFit& moving) const {
    EffectFit best = moving;
    for (const Effect* effect : library_) {
      if (!effect->IsStochastic() || moving.effects.back().effect->IsStochastic()) continue;
      const EffectFit both = WithStochasticEffect(moving, FitStochastic(*effect, moving.errors));
      if (both.score < best.score - kScoreToAddEffect) best = both;
    }
    return best;
  }

  /// Without what it can do without.
  EffectFit Pruned(EffectFit fit) const {
    bool pruned = true;
    while (pruned && fit.effects.size() > 1) {
      pruned = false;
      for (std::size_t drop = 0; drop < fit.effects.size(); ++drop) {
        EffectFit fewer = fit;
        fewer.effects.erase(fewer.effects.begin() + static_cast<std::ptrdiff_t>(drop));
        fewer = Refitted(fewer);
        if (fit.score < fewer.score - kScoreToAddEffect) continue;
        fit = fewer;
        pruned = true;
        break;
      }
    }
    return fit;
  }

 private:
  EffectFit Fit(const std::vector<const Effect*>& effects,
                const std::vector<Eigen::VectorXd>& starts) const {
    return AboveNominalGain(
        FitEffects(problem_.runs, problem_.nominal.boat, problem_.metric, effects, starts));
  }

  EffectFit Refitted(const EffectFit& old) const {
    return AboveNominalGain(Refit(old, problem_, problem_.metric, threads_));
  }

  EffectFit AboveNominalGain(EffectFit fit) const {
    for (const Effect* effect : fit.Effects()) fit.score += nominal_gain_.at(effect);
    return fit;
  }

  EffectFit FitStochastic(const Effect& effect, const Eigen::MatrixXd& errors) const {
    return FitStochasticExcitation(effect, problem_, problem_.metric, errors, threads_);
  }

  void MeasureNominalGains() {
    for (const Effect* effect : library_) nominal_gain_[effect] = 0.0;
    for (const Sensitivity& day : problem_.nominal.days) {
      const ResidualMetric metric(problem_.nominal, day, EveryWindow(day),
                                  problem_.metric.FreesCoefficients());
      for (auto& [effect, gain] : nominal_gain_) {
        if (effect->IsStochastic()) continue;
        const double score = ScoreTest(*effect, metric, day.errors, day, problem_.parameter_refs);
        const double effective_observations =
            problem_.metric.EffectiveObservations() / metric.EffectiveObservations();
        gain = std::max(gain, -kNominalGainFactor * effective_observations * score);
      }
    }
  }

  /// By how much evidence their linear guess promises, the most first.
  std::vector<const Effect*> ByScoreTest(std::vector<const Effect*> effects,
                                         const Eigen::MatrixXd& errors) const {
    std::vector<std::pair<double, const Effect*>> scored;
    for (const Effect* effect : effects) {
      scored.emplace_back(
          ScoreTest(*effect, problem_.metric, errors, problem_.recording, problem_.parameter_refs),
          effect);
    }
    std::stable_sort(scored.begin(), scored.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    for (std::size_t i = 0; i < effects.size(); ++i) effects[i] = scored[i].second;
    return effects;
  }

  const DiagnosisProblem& problem_;
  std::span<const Effect* const> library_;
  std::size_t threads_;
  std::map<const Effect*, double> nominal_gain_;  ///< evidence that is none, by effect
};

}  // namespace

double Distance(const EffectFit& one, const EffectFit& other, const ResidualMetric& metric) {
  if (StochasticEffectsIn(one) != StochasticEffectsIn(other))
    return std::numeric_limits<double>::infinity();
  const double apart =
      metric.SquaredMahalanobis(metric.Whiten(one.errors) - metric.Whiten(other.errors));
  return LogEvidenceOf(metric.EffectiveObservations(), apart / std::min(one.square, other.square));
}

Hypotheses Search(const DiagnosisProblem& problem, std::span<const Effect* const> library,
                  std::size_t most_effects, std::size_t threads,
                  const std::function<void(double)>& tell) {
  const HypothesisSearch searching(problem, library, threads);
  Hypotheses hypotheses;
  hypotheses.singles = searching.Singles([&](double share) { tell(0.6 * share); });
  std::vector<EffectFit> level(
      hypotheses.singles.begin(),
      hypotheses.singles.begin() +
          static_cast<std::ptrdiff_t>(std::min(kSeedHypotheses, hypotheses.singles.size())));
  for (std::size_t count = 2; count <= most_effects; ++count) {
    std::vector<EffectFit> next;
    for (const EffectFit& first : level) {
      if (first.effects.back().effect->IsStochastic()) continue;
      for (EffectFit& more : searching.WithOneMore(first, hypotheses.singles)) {
        if (more.score < first.score - kScoreToAddEffect) next.push_back(std::move(more));
      }
      EffectFit stochastic_mean_squares = searching.WithStochastic(first);
      if (stochastic_mean_squares.effects.size() == count)
        next.push_back(std::move(stochastic_mean_squares));
    }
    if (next.empty()) break;
    std::sort(next.begin(), next.end(), HasLowerScore);
    const EffectFit best = searching.Pruned(next.front());
    const bool grew = best.effects.size() == count;
    if (grew) hypotheses.combined.push_back(best);
    tell(0.6 + 0.4 * static_cast<double>(count) / static_cast<double>(most_effects));
    if (!grew) break;
    level = {best};
  }
  std::sort(hypotheses.combined.begin(), hypotheses.combined.end(), HasLowerScore);
  tell(1.0);
  return hypotheses;
}

}  // namespace telltale
