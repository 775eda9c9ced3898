#include "telltale/core/diagnosis/report/delay_conclusion.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "telltale/core/base/format_number.hpp"
#include "telltale/core/diagnosis/delays/delay_difference.hpp"

namespace telltale {
namespace {

bool Has(std::span<const Effect* const> library, const Effect* effect) {
  return std::ranges::find(library, effect) != library.end();
}

/// The late channels as effects that act together, by what their delays say alone. None where no
/// channel of the library's is late.
std::optional<EffectFit> LateChannels(const std::vector<DelayDifference>& delays,
                                      std::span<const Effect* const> library,
                                      const DiagnosisProblem& problem) {
  EffectFit fit;
  std::vector<double> variances;
  for (const DelayDifference& delay : delays) {
    const Effect& effect = EffectOf(delay.channel);
    if (!IsLate(delay) || !Has(library, &effect)) continue;
    const double upper = effect.Parameters().front().upper;
    fit.effects.push_back({&effect, {std::min(delay.difference_s, upper)}});
    fit.score += delay.score;
    variances.push_back(delay.standard_deviation_s * delay.standard_deviation_s);
  }
  if (fit.effects.empty()) return std::nullopt;
  fit.covariance =
      Eigen::Map<const Eigen::VectorXd>(variances.data(), std::ssize(variances)).asDiagonal();
  fit.errors = problem.runs.Errors(problem.nominal.boat.With(fit.effects));
  fit.square = problem.metric.SquaredMahalanobis(problem.metric.Whiten(fit.errors));
  return fit;
}

/// The same with a thrust that follows slowly in place of one that follows late: the delays of
/// commands are found for the model's own time constant. A lag of so much, or an output that
/// travels twice as long, comes as late on average.
std::vector<EffectFit> SlowInsteadOfLate(const EffectFit& late,
                                         std::span<const Effect* const> library) {
  std::vector<EffectFit> slow;
  const auto commands = std::ranges::find(late.effects, &EffectOf(DelayedChannel::kCommands),
                                          &ModelledEffect::effect);
  if (commands == late.effects.end()) return slow;
  const double delay_s = commands->values.front();
  for (const ModelledEffect& instead :
       {ModelledEffect{FindEffect("thruster_lag"), {delay_s}},
        ModelledEffect{FindEffect("output_slew"), {2.0 * delay_s}}}) {
    if (!Has(library, instead.effect)) continue;
    EffectFit& fit = slow.emplace_back(late);
    fit.effects[static_cast<std::size_t>(commands - late.effects.begin())] = instead;
  }
  return slow;
}

/// By (91), against no effect alone.
Ranking RankingOf(const EffectFit& late, std::vector<EffectFit> equivalent) {
  Ranking ranking;
  ranking.no_effect = 1.0 / (1.0 + std::exp(-0.5 * late.score));
  ranking.fits.push_back({late, 1.0 - ranking.no_effect, std::move(equivalent)});
  return ranking;
}

/// Whether free runs name a cause for sure that the delays do not call in question: it explains a
/// gap, or is the likelier one.
bool Outweighs(const Conclusion& by_free_runs, const EffectFit& late) {
  const bool is_named = by_free_runs.verdict == Verdict::kExplained ||
                        by_free_runs.verdict == Verdict::kPartlyExplained;
  return is_named && (by_free_runs.excess_explained || by_free_runs.best.score <= late.score);
}

}  // namespace

void ConcludeFromDelays(const std::vector<DelayDifference>& delays,
                        std::span<const Effect* const> library, const DiagnosisProblem& problem,
                        const HorizonErrors& main, std::uint64_t seed, Conclusion& conclusion) {
  std::optional<EffectFit> late = LateChannels(delays, library, problem);
  if (!late || Outweighs(conclusion, *late)) return;
  Conclusion by_delays;
  by_delays.best = *std::move(late);
  by_delays.folds.fill(by_delays.best);
  by_delays.cross_validated =
      CrossValidatedErrorsOf(by_delays.folds, main.runs, problem.nominal.boat);
  by_delays.excess_explained =
      ExcessExplainedAt(main, by_delays.cross_validated, kAllChannels, seed);
  by_delays.assessment = GapAssessment::kMaterial;
  by_delays.ranking = RankingOf(by_delays.best, SlowInsteadOfLate(by_delays.best, library));
  by_delays.verdict =
      VerdictOf(by_delays.assessment, by_delays.ranking, by_delays.excess_explained);
  by_delays.is_likely = true;
  const bool leaves_a_material_gap =
      conclusion.assessment == GapAssessment::kMaterial && by_delays.verdict != Verdict::kExplained;
  if (!leaves_a_material_gap) conclusion = std::move(by_delays);
}

std::string DescribeLateChannels(const std::vector<DelayDifference>& delays) {
  std::string late;
  for (const DelayDifference& delay : delays) {
    if (!IsLate(delay)) continue;
    late.append(late.empty() ? "" : ", and ")
        .append(delay.channel == DelayedChannel::kCommands ? "commands act " : "positions are ")
        .append(FormatNumber(delay.difference_s, 2))
        .append(" s (standard deviation ")
        .append(FormatNumber(delay.standard_deviation_s, 2))
        .append(" s) later than on the references");
  }
  if (late.empty()) return late;
  return "By the delays that each recording shows by itself, " + late + ".";
}

}  // namespace telltale
