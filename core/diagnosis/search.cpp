#include "telltale/core/diagnosis/search.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <mutex>

#include "telltale/core/diagnosis/shaking.hpp"
#include "telltale/core/linear_algebra/decompositions.hpp"
#include "telltale/core/parallel.hpp"

namespace telltale {
namespace {

constexpr std::size_t kFittedInFull = 14;  // of the effects that the score test likes best
constexpr std::size_t kSeconds = 5;        // tried beside each promising first
constexpr std::size_t kFirsts = 2;
constexpr double kBeyondHealthy = 1.5;

bool Contains(const EffectFit& fit, const Effect* effect) {
  const auto effects = fit.Effects();
  return std::find(effects.begin(), effects.end(), effect) != effects.end();
}

/// What free runs do not tell apart by where they lead.
std::vector<const Effect*> ShakersIn(const EffectFit& fit) {
  std::vector<const Effect*> shakers = fit.Effects();
  std::erase_if(shakers, [](const Effect* effect) { return !effect->Shakes(); });
  return shakers;
}

bool Likelier(const EffectFit& a, const EffectFit& b) {
  return a.score < b.score;
}

class Searching {
 public:
  Searching(const Evidence& evidence, std::span<const Effect* const> library, std::size_t threads)
      : evidence_(evidence), library_(library), threads_(threads) {
    CompareWithHealth();
  }

  std::vector<EffectFit> Singles(const std::function<void(double)>& tell) const {
    std::vector<const Effect*> moving;
    std::vector<EffectFit> fits;
    for (const Effect* effect : library_) {
      if (effect->Shakes()) {
        fits.push_back(Shaken(*effect, evidence_.recording.errors));
      } else {
        moving.push_back(effect);
      }
    }
    const auto ranked = ByScoreTest(moving, evidence_.recording.errors);
    std::vector<EffectFit> fitted(std::min(kFittedInFull, ranked.size()));
    std::mutex telling;
    std::size_t done = 0;
    ForEachIndex(fitted.size(), threads_, [&](std::size_t i) {
      const Effect* effect = ranked[i];
      fitted[i] = Fit({effect}, StartsOf(*effect, evidence_.judge, evidence_.recording.errors,
                                         evidence_.recording, evidence_.slots));
      const std::lock_guard lock(telling);
      tell(static_cast<double>(++done) / static_cast<double>(fitted.size()));
    });
    fits.insert(fits.end(), fitted.begin(), fitted.end());
    std::sort(fits.begin(), fits.end(), Likelier);
    return fits;
  }

  /// The best fits of one effect more than `first` has.
  std::vector<EffectFit> WithOneMore(const EffectFit& first,
                                     const std::vector<EffectFit>& singles) const {
    std::vector<const Effect*> others;
    for (const Effect* effect : library_) {
      if (Contains(first, effect) || effect->Shakes()) continue;
      const auto single = std::find_if(singles.begin(), singles.end(), [&](const EffectFit& fit) {
        return fit.effects.front().effect == effect;
      });
      const bool of_its_class = single != singles.end() && first.effects.size() == 1 &&
                                Distance(first, *single, evidence_.judge) < kClassDistance;
      if (!of_its_class) others.push_back(effect);
    }
    const auto ranked = ByScoreTest(others, first.errors);
    std::vector<EffectFit> fitted(std::min(kSeconds, ranked.size()));
    ForEachIndex(fitted.size(), threads_, [&](std::size_t i) {
      // The linear guess: what else there is has been fitted already.
      const Eigen::VectorXd start =
          StartsOf(*ranked[i], evidence_.judge, first.errors, evidence_.recording, evidence_.slots)
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
  EffectFit WithShaking(const EffectFit& moving) const {
    EffectFit best = moving;
    for (const Effect* effect : library_) {
      if (!effect->Shakes() || moving.effects.back().effect->Shakes()) continue;
      const EffectFit both = Beside(moving, Shaken(*effect, moving.errors));
      if (both.score < best.score - kWorthwhile) best = both;
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
        fewer = Again(fewer);
        if (fit.score < fewer.score - kWorthwhile) continue;
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
    return BeyondHealth(
        FitEffects(evidence_.runs, evidence_.healthy.boat, evidence_.judge, effects, starts));
  }

  EffectFit Again(const EffectFit& old) const {
    return BeyondHealth(FitAgain(old, evidence_, evidence_.judge, threads_));
  }

  EffectFit BeyondHealth(EffectFit fit) const {
    for (const Effect* effect : fit.Effects()) fit.score += healthy_gain_.at(effect);
    return fit;
  }

  EffectFit Shaken(const Effect& effect, const Eigen::MatrixXd& errors) const {
    return FitShaking(effect, evidence_, evidence_.judge, errors, threads_);
  }

  void CompareWithHealth() {
    for (const Effect* effect : library_) healthy_gain_[effect] = 0.0;
    for (const Sensitivity& day : evidence_.healthy.days) {
      const Judge judge(evidence_.healthy, day, EveryWindow(day), evidence_.judge.FreesBase());
      for (auto& [effect, gain] : healthy_gain_) {
        if (effect->Shakes()) continue;
        const double score = ScoreTest(*effect, judge, day.errors, day, evidence_.slots);
        const double looks = evidence_.judge.Looks() / judge.Looks();
        gain = std::max(gain, -kBeyondHealthy * looks * score);
      }
    }
  }

  /// By how much evidence their linear guess promises, the most first.
  std::vector<const Effect*> ByScoreTest(std::vector<const Effect*> effects,
                                         const Eigen::MatrixXd& errors) const {
    std::vector<std::pair<double, const Effect*>> scored;
    for (const Effect* effect : effects) {
      scored.emplace_back(
          ScoreTest(*effect, evidence_.judge, errors, evidence_.recording, evidence_.slots),
          effect);
    }
    std::stable_sort(scored.begin(), scored.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    for (std::size_t i = 0; i < effects.size(); ++i) effects[i] = scored[i].second;
    return effects;
  }

  const Evidence& evidence_;
  std::span<const Effect* const> library_;
  std::size_t threads_;
  std::map<const Effect*, double> healthy_gain_;  ///< evidence that is none, by effect
};

}  // namespace

double Distance(const EffectFit& one, const EffectFit& other, const Judge& judge) {
  if (ShakersIn(one) != ShakersIn(other)) return std::numeric_limits<double>::infinity();
  const double apart = judge.Square(judge.See(one.errors) - judge.See(other.errors));
  return NatsOf(judge.Looks(), apart / std::min(one.square, other.square));
}

Explanations Search(const Evidence& evidence, std::span<const Effect* const> library,
                    std::size_t most_effects, std::size_t threads,
                    const std::function<void(double)>& tell) {
  const Searching searching(evidence, library, threads);
  Explanations explanations;
  explanations.singles = searching.Singles([&](double share) { tell(0.6 * share); });
  std::vector<EffectFit> level(
      explanations.singles.begin(),
      explanations.singles.begin() +
          static_cast<std::ptrdiff_t>(std::min(kFirsts, explanations.singles.size())));
  for (std::size_t count = 2; count <= most_effects; ++count) {
    std::vector<EffectFit> next;
    for (const EffectFit& first : level) {
      if (first.effects.back().effect->Shakes()) continue;
      for (EffectFit& more : searching.WithOneMore(first, explanations.singles)) {
        if (more.score < first.score - kWorthwhile) next.push_back(std::move(more));
      }
      EffectFit shaken = searching.WithShaking(first);
      if (shaken.effects.size() == count) next.push_back(std::move(shaken));
    }
    if (next.empty()) break;
    std::sort(next.begin(), next.end(), Likelier);
    const EffectFit best = searching.Pruned(next.front());
    const bool grew = best.effects.size() == count;
    if (grew) explanations.together.push_back(best);
    tell(0.6 + 0.4 * static_cast<double>(count) / static_cast<double>(most_effects));
    if (!grew) break;
    level = {best};
  }
  std::sort(explanations.together.begin(), explanations.together.end(), Likelier);
  tell(1.0);
  return explanations;
}

}  // namespace telltale
