#include "telltale/core/diagnosis/report/conclusion.hpp"

namespace telltale {
namespace {

/// The score that makes a gap material. What comes and goes makes errors larger: where they are no
/// larger than nominal ones, their scatter is no evidence of it.
double MaterialScoreOf(const Conclusion& conclusion) {
  const bool scatters_nothing =
      TraitsOf(conclusion.best).is_intermittent && !conclusion.excess_explained;
  return scatters_nothing ? 0.0 : conclusion.best.score;
}

}  // namespace

Conclusion Conclude(const Hypotheses& hypotheses, const DiagnosisProblem& problem,
                    const HorizonErrors& main, std::uint64_t seed,
                    std::optional<double> squared_limit_of_days) {
  Conclusion conclusion;
  conclusion.best = BestHypothesis(hypotheses);
  conclusion.folds = FitOnFolds(conclusion.best, problem);
  conclusion.cross_validated =
      CrossValidatedErrorsOf(conclusion.folds, main.runs, problem.nominal.boat);
  conclusion.excess_explained =
      ExcessExplainedAt(main, conclusion.cross_validated, kAllChannels, seed);
  const LackOfFit lack_of_fit =
      AssessLackOfFit(conclusion.best, conclusion.cross_validated, problem);
  const Eigen::VectorXd gaps = main.SquaredGapsOf(kAllChannels);
  conclusion.assessment =
      AssessGap(gaps.mean(), UpperBound(gaps, BlocksOf(main.runs), seed),
                main.floor.SquaredLimit(kAllChannels), MaterialScoreOf(conclusion), lack_of_fit);
  conclusion.ranking = Rank(hypotheses, problem.metric, lack_of_fit);
  conclusion.verdict =
      VerdictOf(conclusion.assessment, conclusion.ranking, conclusion.excess_explained);
  if (conclusion.verdict == Verdict::kUnknownCause &&
      gaps.mean() <= squared_limit_of_days.value_or(0.0)) {
    conclusion.assessment = GapAssessment::kUndecided;
    conclusion.verdict = Verdict::kInsufficientData;
  }
  conclusion.is_likely = IsLikely(conclusion.assessment, conclusion.ranking);
  return conclusion;
}

}  // namespace telltale
