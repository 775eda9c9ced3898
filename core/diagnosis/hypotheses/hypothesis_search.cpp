#include "telltale/core/diagnosis/hypotheses/hypothesis_search.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <mutex>
#include <optional>

#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/base/parallel.hpp"
#include "telltale/core/diagnosis/diagnosis_constants.hpp"
#include "telltale/core/diagnosis/hypotheses/nominal_gain.hpp"
#include "telltale/core/diagnosis/hypotheses/refit.hpp"
#include "telltale/core/diagnosis/hypotheses/score_test.hpp"
#include "telltale/core/diagnosis/hypotheses/stochastic_excitation.hpp"

namespace telltale {
namespace {

constexpr SearchConstants kSearch = kDiagnosis.search;

bool Contains(const EffectFit& fit, const Effect* effect) {
  const auto effects = fit.Effects();
  return std::find(effects.begin(), effects.end(), effect) != effects.end();
}

bool HasLowerScore(const EffectFit& a, const EffectFit& b) {
  return a.score < b.score;
}

class HypothesisSearch {
 public:
  HypothesisSearch(const DiagnosisProblem& problem, std::span<const Effect* const> library,
                   const Hypotheses& known, std::size_t threads)
      : problem_(problem),
        library_(library),
        known_(known),
        threads_(threads),
        error_model_(ErrorModelOf(problem.runs, problem.nominal.boat)),
        nominal_gains_(NominalGains(problem, library)) {
    std::ranges::copy_if(library, std::back_inserter(stochastic_), &Effect::IsStochastic);
    std::ranges::copy_if(library, std::back_inserter(hidden_), [&](const Effect* effect) {
      return HidesBelowThreshold(*effect, problem.metric, problem.recording,
                                 problem.parameter_refs);
    });
  }

  /// Fits of the effects that the score test ranks first, and of every stochastic effect.
  std::vector<EffectFit> Singles(const std::function<void(double)>& report_progress) const {
    std::vector<const Effect*> deterministic;
    std::vector<EffectFit> fits;
    for (const Effect* effect : stochastic_) {
      fits.push_back(FitStochasticExcitation(*effect, problem_.excitation, problem_,
                                             problem_.metric, problem_.recording.errors));
    }
    std::ranges::copy_if(library_, std::back_inserter(deterministic),
                         [](const Effect* effect) { return !effect->IsStochastic(); });
    auto ranked =
        MostPromising(kSearch.effects_fitted_in_full,
                      ByScoreTest(deterministic, problem_.recording.errors, problem_.metric));
    if (HasKnown()) EraseUnpromisingBehindFirst(ranked);
    std::vector<EffectFit> fitted(ranked.size());
    std::mutex reporting;
    std::size_t done = 0;
    ForEachIndex(fitted.size(), threads_, [&](std::size_t i) {
      const Effect& effect = *ranked[i].effect;
      fitted[i] = Fit({&effect}, StartsOfSingle(effect));
      const std::lock_guard lock(reporting);
      report_progress(static_cast<double>(++done) / static_cast<double>(fitted.size()));
    });
    fits.insert(fits.end(), fitted.begin(), fitted.end());
    std::sort(fits.begin(), fits.end(), HasLowerScore);
    return fits;
  }

  /// A hypothesis with one effect more, and by how much its score has to be lower for that.
  struct Addition {
    EffectFit fit;
    double needed = 0.0;
  };

  /// Fits of one deterministic effect more than `first` has, of those to choose from.
  std::vector<Addition> WithOneMore(const EffectFit& first,
                                    const std::vector<const Effect*>& choice) const {
    const ResidualMetric metric = first.ScatteredMetric(problem_.metric);
    auto ranked =
        MostPromising(kSearch.candidates_per_seed, ByScoreTest(choice, first.errors, metric));
    std::erase_if(ranked, [&](const Scored& scored) { return IsUnpromising(scored); });
    std::vector<Addition> additions(ranked.size());
    const EffectFit deterministic = first.Deterministic();
    const Effect* stochastic = first.Stochastic();
    ForEachIndex(additions.size(), threads_, [&](std::size_t i) {
      // The linearised minimum alone, or beyond the threshold: the other effects start from their
      // fit.
      const Effect& effect = *ranked[i].effect;
      const auto starts =
          StartsOf(effect, metric, first.errors, problem_.recording, problem_.parameter_refs);
      const Eigen::VectorXd& start = Hides(effect) ? starts.back() : starts.front();
      const Eigen::VectorXd values = deterministic.Values();
      Eigen::VectorXd stacked(values.size() + start.size());
      stacked << values, start;
      auto effects = deterministic.Effects();
      effects.push_back(&effect);
      additions[i] = {stochastic != nullptr ? FitBeside(*stochastic, effects, stacked)
                                            : Fit(effects, {stacked}),
                      FallNeededBy(ranked[i], first)};
    });
    return additions;
  }

  /// `fit` with a stochastic effect where the evidence asks for one; else `fit` itself.
  EffectFit WithStochastic(const EffectFit& fit) const {
    EffectFit best = fit;
    if (fit.Stochastic() != nullptr) return best;
    for (const Effect* effect : stochastic_) {
      // Without a peak there is no scatter to allow for. What the others do may hide one.
      if (PeakBeside(*effect, fit.effects, problem_).gain == 0.0) continue;
      EffectFit both = FitBeside(*effect, fit.Effects(), fit.Values());
      if (both.score < best.score - ScoreToAdd(*effect, fit)) best = std::move(both);
    }
    return best;
  }

  const std::map<const Effect*, double>& Gains() const { return nominal_gains_; }

  /// The deterministic effects that `first` does not have, less those that this recording cannot
  /// separate from it where it stands alone, and those that escape the score test and have less
  /// evidence alone than a second effect needs at least.
  std::vector<const Effect*> SeparableFrom(const EffectFit& first,
                                           std::span<const EffectFit> singles) const {
    std::vector<const Effect*> others;
    for (const Effect* effect : library_) {
      if (Contains(first, effect) || effect->IsStochastic()) continue;
      const EffectFit* single = SingleOf(*effect, singles);
      const bool collinear = single != nullptr && first.effects.size() == 1 &&
                             Distance(first, *single, problem_.metric) < kSearch.separable_nats;
      const bool has_little =
          Escapes(*effect) && (single != nullptr ? single->score : KnownScoreOf(*effect)) >
                                  -kSearch.score_to_add_weather;
      if (!collinear && !has_little) others.push_back(effect);
    }
    return others;
  }

  /// What is likeliest with another effect in place of one of `fit`; `fit` where nothing is
  /// likelier.
  EffectFit Exchanged(const EffectFit& fit, const std::vector<EffectFit>& singles) const {
    EffectFit likeliest = fit;
    for (std::size_t place = 0; place < fit.effects.size(); ++place) {
      const Effect* effect = fit.effects[place].effect;
      if (effect->IsStochastic()) continue;
      const EffectFit fewer = Less(fit, place);
      auto choice = SeparableFrom(fewer, singles);
      std::erase(choice, effect);
      for (Addition& other : WithOneMore(fewer, choice)) {
        if (HasLowerScore(other.fit, likeliest)) likeliest = std::move(other.fit);
      }
    }
    return likeliest;
  }

  /// `fit` less the effects whose removal raises the score by too little.
  EffectFit Pruned(EffectFit fit) const {
    bool pruned = true;
    while (pruned && fit.effects.size() > 1) {
      pruned = false;
      for (std::size_t drop = 0; drop < fit.effects.size(); ++drop) {
        const Effect* dropped = fit.effects[drop].effect;
        const EffectFit fewer = Less(fit, drop);
        if (fit.score < fewer.score - ScoreToAdd(*dropped, fewer)) continue;
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
    return AboveNominalGain(FitEffects(error_model_, problem_.metric, effects, starts));
  }

  std::vector<Eigen::VectorXd> StartsOfSingle(const Effect& effect) const {
    if (const EffectFit* known = SingleOf(effect, known_.singles)) return {known->Values()};
    return StartsOf(effect, problem_.metric, problem_.recording.errors, problem_.recording,
                    problem_.parameter_refs);
  }

  /// Null where there is none of it.
  static const EffectFit* SingleOf(const Effect& effect, std::span<const EffectFit> singles) {
    const auto single = std::ranges::find_if(
        singles, [&](const EffectFit& fit) { return fit.effects.front().effect == &effect; });
    return single != singles.end() ? &*single : nullptr;
  }

  /// The fit without one of its effects.
  EffectFit Less(EffectFit fit, std::size_t place) const {
    fit.effects.erase(fit.effects.begin() + static_cast<std::ptrdiff_t>(place));
    return AboveNominalGain(Refit(fit, problem_, problem_.metric));
  }

  EffectFit AboveNominalGain(EffectFit fit) const {
    for (const Effect* effect : fit.Effects()) fit.score += nominal_gains_.at(effect);
    return fit;
  }

  EffectFit FitBeside(const Effect& stochastic, const std::vector<const Effect*>& effects,
                      const Eigen::VectorXd& start) const {
    return AboveNominalGain(
        telltale::FitBeside(stochastic, problem_, problem_.metric, effects, start));
  }

  /// An effect and what its score test promises.
  struct Scored {
    const Effect* effect;
    double score;
  };

  /// The first `count`, and those beyond them that the score test can say nothing of.
  std::vector<Scored> MostPromising(std::size_t count, std::vector<Scored> ranked) const {
    const auto beyond =
        ranked.begin() + static_cast<std::ptrdiff_t>(std::min(count, ranked.size()));
    ranked.erase(std::remove_if(beyond, ranked.end(),
                                [&](const Scored& scored) {
                                  return !Escapes(*scored.effect) && !Gusts(*scored.effect);
                                }),
                 ranked.end());
    return ranked;
  }

  /// Whether the score test, which is of small and steady sizes, says nothing of an effect.
  bool Escapes(const Effect& effect) const { return Hides(effect) || effect.IsIntermittent(); }

  /// Gusts may show where their mean does not.
  static bool Gusts(const Effect& effect) { return effect.Facts().turbulence_intensity > 0.0; }

  /// Whether the score test promises next to nothing. An effect of which it cannot tell is
  /// unpromising only where it mattered to none of the known hypotheses.
  bool IsUnpromising(const Scored& scored) const {
    if (scored.score <= -kSearch.least_promise) return false;
    if (HasKnown()) return !Mattered(*scored.effect);
    return !Gusts(*scored.effect) && !Escapes(*scored.effect);
  }

  bool HasKnown() const { return !known_.singles.empty(); }

  /// Whether a known hypothesis gives evidence of the effect, alone or beside others.
  bool Mattered(const Effect& effect) const {
    return KnownScoreOf(effect) <= -kSearch.least_promise ||
           std::ranges::any_of(known_.combined, [&](const EffectFit& combination) {
             return Contains(combination, &effect);
           });
  }

  /// Weather of whose mean the score test promises nothing needs as much as a fault does.
  static double FallNeededBy(const Scored& scored, const EffectFit& to) {
    return scored.score > -kSearch.least_promise ? kSearch.score_to_add_effect
                                                 : ScoreToAdd(*scored.effect, to);
  }

  /// Leaves one at least.
  void EraseUnpromisingBehindFirst(std::vector<Scored>& ranked) const {
    if (ranked.empty()) return;
    const auto unneeded =
        std::remove_if(ranked.begin() + 1, ranked.end(),
                       [&](const Scored& scored) { return IsUnpromising(scored); });
    ranked.erase(unneeded, ranked.end());
  }

  /// Of the known single effect; zero where none was fitted.
  double KnownScoreOf(const Effect& effect) const {
    const EffectFit* known = SingleOf(effect, known_.singles);
    return known != nullptr ? known->score : 0.0;
  }

  bool Hides(const Effect& effect) const {
    return std::ranges::find(hidden_, &effect) != hidden_.end();
  }

  /// The effects by the evidence that their score test promises, the most first.
  std::vector<Scored> ByScoreTest(const std::vector<const Effect*>& effects,
                                  const Eigen::MatrixXd& errors,
                                  const ResidualMetric& metric) const {
    std::vector<Scored> ranked;
    for (const Effect* effect : effects) {
      ranked.push_back({effect, ScoreTest(*effect, metric, errors, problem_.recording,
                                          problem_.parameter_refs)});
    }
    std::ranges::stable_sort(ranked, {}, &Scored::score);
    return ranked;
  }

  const DiagnosisProblem& problem_;
  std::span<const Effect* const> library_;
  const Hypotheses& known_;  ///< of nearly the same problem
  std::size_t threads_;
  ErrorModel error_model_;
  std::vector<const Effect*> stochastic_;
  std::vector<const Effect*> hidden_;  ///< below a threshold
  std::map<const Effect*, double> nominal_gains_;
};

/// Combinations of one effect more than those of `level` have, by score.
std::vector<EffectFit> NextLevel(const HypothesisSearch& search,
                                 const std::vector<EffectFit>& level,
                                 const std::vector<EffectFit>& singles) {
  std::vector<EffectFit> next;
  for (const EffectFit& first : level) {
    for (auto& [more, needed] : search.WithOneMore(first, search.SeparableFrom(first, singles))) {
      if (more.score < first.score - needed) next.push_back(std::move(more));
    }
    EffectFit with_stochastic = search.WithStochastic(first);
    if (with_stochastic.effects.size() > first.effects.size())
      next.push_back(std::move(with_stochastic));
  }
  std::sort(next.begin(), next.end(), HasLowerScore);
  return next;
}

bool HasSameEffects(const EffectFit& a, const EffectFit& b) {
  return std::ranges::is_permutation(a.Effects(), b.Effects());
}

/// Adds a fit. Of two with the same effects the better one stays.
void Keep(const EffectFit& fit, std::vector<EffectFit>& fits) {
  const auto same =
      std::ranges::find_if(fits, [&](const EffectFit& kept) { return HasSameEffects(kept, fit); });
  if (same == fits.end()) {
    fits.push_back(fit);
  } else if (HasLowerScore(fit, *same)) {
    *same = fit;
  }
}

/// What grows from `level`, less what it does not need. Nothing where nothing grows that is larger
/// than the level or likelier than all that is known, of as many effects as there may be.
std::optional<EffectFit> Grown(const HypothesisSearch& search, const std::vector<EffectFit>& level,
                               const Hypotheses& hypotheses, std::size_t most_effects) {
  const std::vector<EffectFit> next = NextLevel(search, level, hypotheses.singles);
  if (next.empty()) return std::nullopt;
  EffectFit grown = search.Pruned(next.front());
  if (grown.effects.size() > most_effects) return std::nullopt;
  const bool is_larger = grown.effects.size() > level.front().effects.size();
  if (!is_larger && !HasLowerScore(grown, BestHypothesis(hypotheses))) return std::nullopt;
  return grown;
}

/// The likeliest combination with one effect exchanged for another. Nothing where none is likelier
/// by as much as separates two hypotheses.
std::optional<EffectFit> Exchanged(const HypothesisSearch& search, const Hypotheses& hypotheses) {
  const EffectFit& best = BestHypothesis(hypotheses);
  if (best.effects.size() < 2) return std::nullopt;
  EffectFit exchanged = search.Exchanged(best, hypotheses.singles);
  if (!(exchanged.score < best.score - 2.0 * kSearch.separable_nats)) return std::nullopt;
  return search.Pruned(std::move(exchanged));
}

}  // namespace

double ScoreToAdd(const Effect& effect, const EffectFit& to) {
  const bool is_first_weather = effect.Facts().is_weather && to.Faults() == to.effects.size();
  return is_first_weather ? kSearch.score_to_add_weather : kSearch.score_to_add_effect;
}

const EffectFit& BestHypothesis(const Hypotheses& hypotheses) {
  const EffectFit& single = hypotheses.singles.front();
  if (hypotheses.combined.empty()) return single;
  return hypotheses.combined.front().score < single.score ? hypotheses.combined.front() : single;
}

double Distance(const EffectFit& one, const EffectFit& other, const ResidualMetric& metric) {
  if (one.Stochastic() != other.Stochastic()) return std::numeric_limits<double>::infinity();
  const ResidualMetric scattered = one.ScatteredMetric(metric);
  const double square =
      scattered.SquaredMahalanobis(scattered.Whiten(one.errors) - scattered.Whiten(other.errors));
  const double by_mean =
      LogEvidenceOf(metric.EffectiveObservations(), square / std::min(one.square, other.square));
  const bool only_one_varies = one.variation.IsEmpty() != other.variation.IsEmpty();
  return only_one_varies ? std::max(by_mean, 0.5 * std::abs(one.score - other.score)) : by_mean;
}

std::vector<EffectFit> SeedsOf(const std::vector<EffectFit>& singles) {
  std::vector<EffectFit> seeds;
  std::size_t deterministic = 0;
  for (const EffectFit& fit : singles) {
    const bool is_seed = fit.Stochastic() != nullptr ? fit.score < -kSearch.score_to_add_weather
                                                     : deterministic++ < kSearch.seed_hypotheses;
    if (is_seed) seeds.push_back(fit);
  }
  return seeds;
}

Hypotheses Search(const DiagnosisProblem& problem, std::span<const Effect* const> library,
                  std::size_t most_effects, std::size_t threads,
                  const std::function<void(double)>& report_progress, const Hypotheses& known) {
  constexpr double kShareOfSingles = 0.6;
  const HypothesisSearch search(problem, library, known, threads);
  Hypotheses hypotheses;
  hypotheses.nominal_gains = search.Gains();
  hypotheses.singles =
      search.Singles([&](double share) { report_progress(kShareOfSingles * share); });
  std::vector<EffectFit> level;
  if (most_effects > 1) level = SeedsOf(hypotheses.singles);
  // Each turn leads to a larger hypothesis or to a likelier one.
  const std::size_t most_turns = 2 * most_effects;
  for (std::size_t turn = 1; turn <= most_turns && !level.empty(); ++turn) {
    std::optional<EffectFit> better = Grown(search, level, hypotheses, most_effects);
    if (!better) better = Exchanged(search, hypotheses);
    if (!better) break;
    Keep(*better, better->effects.size() > 1 ? hypotheses.combined : hypotheses.singles);
    level = {*std::move(better)};
    report_progress(kShareOfSingles + (1.0 - kShareOfSingles) * static_cast<double>(turn) /
                                          static_cast<double>(most_turns));
  }
  std::sort(hypotheses.singles.begin(), hypotheses.singles.end(), HasLowerScore);
  std::sort(hypotheses.combined.begin(), hypotheses.combined.end(), HasLowerScore);
  report_progress(1.0);
  return hypotheses;
}

}  // namespace telltale
