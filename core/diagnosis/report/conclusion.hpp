#pragma once

#include <cstdint>
#include <optional>

#include "telltale/core/diagnosis/diagnosis.hpp"
#include "telltale/core/diagnosis/hypotheses/cross_validation.hpp"
#include "telltale/core/diagnosis/hypotheses/ranking.hpp"
#include "telltale/core/diagnosis/report/horizon_gap.hpp"

namespace telltale {

/// What follows from the hypotheses at the main horizon.
struct Conclusion {
  EffectFit best;                                   ///< the likeliest hypothesis
  FoldFits folds;                                   ///< the same, fitted to each fold
  CrossValidatedErrors cross_validated;             ///< with the folds' fits
  std::optional<ExcessExplained> excess_explained;  ///< of all channels; none without a gap
  GapAssessment assessment = GapAssessment::kUndecided;
  Ranking ranking;
  Verdict verdict = Verdict::kUnknown;
  bool is_likely = false;  ///< the best hypothesis is more probable than an unknown cause
};

/// Cross-validates the likeliest hypothesis, assesses the gap and ranks all hypotheses.
/// `main`: errors at the main horizon, those of `problem`. `squared_limit_of_days`: what nominal
/// days stay below that took no part in the baseline, where that is known. A gap within it is
/// undecided unless its cause is certain.
Conclusion Conclude(const Hypotheses& hypotheses, const DiagnosisProblem& problem,
                    const HorizonErrors& main, std::uint64_t seed,
                    std::optional<double> squared_limit_of_days = std::nullopt);

}  // namespace telltale
