#include "diagnosis/search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>

#include <Eigen/Cholesky>

#include "diagnosis/shaking.hpp"
#include "parallel.hpp"

namespace telltale {
namespace {

constexpr std::size_t kFittedInFull = 12;  // of the effects that the score test likes best
constexpr std::size_t kSeconds = 5;        // tried beside each promising first
constexpr std::size_t kFirsts = 2;
constexpr std::size_t kComparedWithHealth = 4;  // of the likeliest
constexpr double kBeyondHealthy = 1.5;
constexpr double kBeyondAnyHealthyDay = 600.0;  // evidence that no healthy day could feign
// Of what an explanation takes away from the squared errors: what a part of it has to account for.
constexpr double kMaterialShare = 0.04;

std::vector<const Effect*> EffectsIn(const EffectFit& fit) {
  std::vector<const Effect*> effects;
  for (const ModelledEffect& modelled : fit.effects) effects.push_back(modelled.effect);
  return effects;
}

Eigen::VectorXd ValuesIn(const EffectFit& fit) {
  std::vector<double> values;
  for (const ModelledEffect& modelled : fit.effects) {
    values.insert(values.end(), modelled.values.begin(), modelled.values.end());
  }
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

bool Contains(const EffectFit& fit, const Effect* effect) {
  const auto effects = EffectsIn(fit);
  return std::find(effects.begin(), effects.end(), effect) != effects.end();
}

bool Shakes(const Effect& effect) {
  const Effect* one = &effect;
  return SlotsOf(std::span(&one, 1)).empty();
}

bool Likelier(const EffectFit& a, const EffectFit& b) {
  return a.score < b.score;
}

class Searching {
 public:
  Searching(const Evidence& evidence, std::span<const Effect* const> library, std::size_t threads)
      : evidence_(evidence), library_(library), threads_(threads) {}

  std::vector<EffectFit> Singles(const std::function<void(double)>& tell) const {
    std::vector<const Effect*> moving;
    std::vector<EffectFit> fits;
    for (const Effect* effect : library_) {
      if (Shakes(*effect)) {
        fits.push_back(FitShaking(*effect, evidence_.runs, evidence_.healthy, evidence_.judge,
                                  evidence_.recording.errors, threads_));
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

  /// Takes back from the likeliest what they would explain of healthy days too.
  void CompareWithHealth(std::vector<EffectFit>& fits) const {
    std::vector<Judge> judges;
    for (const Sensitivity& day : evidence_.healthy.days) {
      judges.emplace_back(evidence_.healthy, day, EveryWindow(day), evidence_.judge.FreesBase());
    }
    const std::size_t compared = std::min(kComparedWithHealth, fits.size());
    ForEachIndex(compared, threads_, [&](std::size_t i) {
      EffectFit& fit = fits[i];
      const Effect& effect = *fit.effects.front().effect;
      if (fit.score > 0.0 || fit.score < -kBeyondAnyHealthyDay || Shakes(effect)) return;
      double healthiest = 0.0;
      for (std::size_t day = 0; day < judges.size(); ++day) {
        const Sensitivity& recording = evidence_.healthy.days[day];
        const auto starts =
            StartsOf(effect, judges[day], recording.errors, recording, evidence_.slots);
        const EffectFit healthy = FitEffects(evidence_.healthy_runs[day], evidence_.healthy.boat,
                                             judges[day], {&effect}, {starts.front()});
        healthiest = std::min(healthiest, healthy.score);
      }
      fit.score -= kBeyondHealthy * healthiest;
    });
    std::stable_sort(fits.begin(), fits.end(), Likelier);
  }

  /// The best fits of one effect more than `first` has.
  std::vector<EffectFit> WithOneMore(const EffectFit& first,
                                     const std::vector<EffectFit>& singles) const {
    std::vector<const Effect*> others;
    for (const Effect* effect : library_) {
      if (Contains(first, effect) || Shakes(*effect)) continue;
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
      std::vector<Eigen::VectorXd> starts;
      for (const Eigen::VectorXd& start : StartsOf(*ranked[i], evidence_.judge, first.errors,
                                                   evidence_.recording, evidence_.slots)) {
        const Eigen::VectorXd values = ValuesIn(first);
        Eigen::VectorXd stacked(values.size() + start.size());
        stacked << values, start;
        starts.push_back(stacked);
        break;  // the linear guess: what else there is has been fitted already
      }
      auto effects = EffectsIn(first);
      effects.push_back(ranked[i]);
      fitted[i] = Fit(effects, starts);
    });
    return fitted;
  }

  /// Whether more is so much likelier than fewer, and explains so much more, as to be believed.
  bool IsWorthwhile(const EffectFit& more, const EffectFit& fewer) const {
    const auto square = [&](const Eigen::MatrixXd& errors) {
      return evidence_.judge.See(errors).squaredNorm();
    };
    const double left = square(more.errors);
    return more.score < fewer.score - kWorthwhile &&
           square(fewer.errors) - left >
               kMaterialShare * (square(evidence_.recording.errors) - left);
  }

  /// Without what it can do without.
  EffectFit Pruned(EffectFit fit) const {
    bool pruned = true;
    while (pruned && fit.effects.size() > 1) {
      pruned = false;
      for (std::size_t drop = 0; drop < fit.effects.size(); ++drop) {
        EffectFit fewer = fit;
        fewer.effects.erase(fewer.effects.begin() + static_cast<std::ptrdiff_t>(drop));
        fewer = Fit(EffectsIn(fewer), {ValuesIn(fewer)});
        if (IsWorthwhile(fit, fewer)) continue;
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
    return FitEffects(evidence_.runs, evidence_.healthy.boat, evidence_.judge, effects, starts);
  }

  /// By how much evidence their linear guess promises, the most first.
  std::vector<const Effect*> ByScoreTest(std::vector<const Effect*> effects,
                                         const Eigen::MatrixXd& errors) const {
    std::vector<std::pair<double, const Effect*>> scored;
    for (const Effect* effect : effects) {
      scored.emplace_back(
          -ScoreTest(*effect, evidence_.judge, errors, evidence_.recording, evidence_.slots),
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
};

}  // namespace

double Distance(const EffectFit& one, const EffectFit& other, const Judge& judge) {
  return 0.5 * judge.Square(judge.See(one.errors) - judge.See(other.errors));
}

Explanations Search(const Evidence& evidence, std::span<const Effect* const> library,
                    std::size_t most_effects, std::size_t threads,
                    const std::function<void(double)>& tell) {
  const Searching searching(evidence, library, threads);
  Explanations explanations;
  explanations.singles = searching.Singles([&](double share) { tell(0.6 * share); });
  searching.CompareWithHealth(explanations.singles);
  std::vector<EffectFit> level(
      explanations.singles.begin(),
      explanations.singles.begin() +
          static_cast<std::ptrdiff_t>(std::min(kFirsts, explanations.singles.size())));
  for (std::size_t count = 2; count <= most_effects; ++count) {
    std::vector<EffectFit> next;
    for (const EffectFit& first : level) {
      if (Shakes(*first.effects.front().effect)) continue;
      for (EffectFit& more : searching.WithOneMore(first, explanations.singles)) {
        if (searching.IsWorthwhile(more, first)) next.push_back(std::move(more));
      }
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
