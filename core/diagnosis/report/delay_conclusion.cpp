#include "telltale/core/diagnosis/report/delay_conclusion.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "telltale/core/diagnosis/delays/delay_difference.hpp"
#include "telltale/core/diagnosis/diagnosis_constants.hpp"

namespace telltale {
namespace {

/// The late channels as effects that act together, by what their delays say alone. None where no
/// channel of the library's is late.
std::optional<EffectFit> LateChannels(const std::vector<DelayDifference>& delays,
                                      std::span<const Effect* const> library,
                                      const DiagnosisProblem& problem) {
  EffectFit fit;
  std::vector<double> variances;
  for (const DelayDifference& delay : delays) {
    const Effect& effect = EffectOf(delay.channel);
    if (!IsLate(delay) || std::ranges::find(library, &effect) == library.end()) continue;
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

/// By (91), against no effect alone.
Ranking RankingOf(const EffectFit& fit) {
  Ranking ranking;
  ranking.no_effect = 1.0 / (1.0 + std::exp(-0.5 * fit.score));
  ranking.fits.push_back({fit, 1.0 - ranking.no_effect, {}});
  return ranking;
}

}  // namespace

void ConcludeFromDelays(const std::vector<DelayDifference>& delays,
                        std::span<const Effect* const> library, const DiagnosisProblem& problem,
                        const HorizonErrors& main, std::uint64_t seed, Conclusion& conclusion) {
  const bool has_certain_cause =
      conclusion.verdict == Verdict::kExplained || conclusion.verdict == Verdict::kPartlyExplained;
  if (has_certain_cause) return;
  std::optional<EffectFit> late = LateChannels(delays, library, problem);
  if (!late) return;
  Conclusion by_delays;
  by_delays.best = *std::move(late);
  by_delays.folds.fill(by_delays.best);
  by_delays.cross_validated =
      CrossValidatedErrorsOf(by_delays.folds, main.runs, problem.nominal.boat);
  by_delays.excess_explained =
      ExcessExplainedAt(main, by_delays.cross_validated, kAllChannels, seed);
  by_delays.assessment = GapAssessment::kMaterial;
  by_delays.ranking = RankingOf(by_delays.best);
  by_delays.verdict =
      VerdictOf(by_delays.assessment, by_delays.ranking, by_delays.excess_explained);
  by_delays.is_likely = true;
  const bool leaves_a_material_gap =
      conclusion.assessment == GapAssessment::kMaterial && by_delays.verdict != Verdict::kExplained;
  if (!leaves_a_material_gap) conclusion = std::move(by_delays);
}

}  // namespace telltale
