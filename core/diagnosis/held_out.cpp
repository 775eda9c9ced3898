#include "telltale/core/diagnosis/held_out.hpp"

#include <algorithm>

#include "telltale/core/diagnosis/shaking.hpp"

namespace telltale {

std::vector<std::size_t> FoldsOf(const FreeRuns& runs) {
  const std::vector<std::size_t> blocks = BlocksOf(runs);
  std::vector<std::size_t> folds(blocks.size());
  for (std::size_t w = 1; w < folds.size(); ++w) {
    folds[w] = blocks[w] == blocks[w - 1] ? folds[w - 1] : (folds[w - 1] + 1) % kFolds;
  }
  return folds;
}

std::vector<std::size_t> WindowsOf(const std::vector<std::size_t>& folds, std::size_t fold) {
  std::vector<std::size_t> windows;
  for (std::size_t w = 0; w < folds.size(); ++w) {
    if (folds[w] == fold) windows.push_back(w);
  }
  return windows;
}

Judge JudgeOfFold(const Evidence& evidence, std::size_t fold) {
  return {evidence.healthy, evidence.recording, WindowsOf(FoldsOf(evidence.runs), fold),
          evidence.judge.FreesBase()};
}

FoldFits FitOnFolds(const EffectFit& fit, const Evidence& evidence) {
  FoldFits fits;
  for (std::size_t fold = 0; fold < kFolds; ++fold) {
    fits[fold] = FitAgain(fit, evidence, JudgeOfFold(evidence, fold), 1);
  }
  return fits;
}

HeldOutErrors ErrorsHeldOut(const FoldFits& fits, const FreeRuns& runs,
                            const AugmentedModel& model) {
  const auto folds = FoldsOf(runs);
  HeldOutErrors held_out;
  held_out.errors.resize(runs.Rows(), static_cast<Eigen::Index>(runs.Windows()));
  for (std::size_t fold = 0; fold < kFolds; ++fold) {
    const Eigen::MatrixXd errors = runs.Errors(model.With(fits[fold].effects));
    for (std::size_t w = 0; w < folds.size(); ++w) {
      if (folds[w] == fold) continue;
      held_out.errors.col(static_cast<Eigen::Index>(w)) = errors.col(static_cast<Eigen::Index>(w));
    }
    held_out.shaken[fold] = ShakenSquares(fits[fold], runs, model);
  }
  return held_out;
}

Eigen::VectorXd SquaredGapsHeldOut(const HeldOutErrors& held_out, const FreeRuns& runs,
                                   const Floor& floor, int channel) {
  Eigen::VectorXd gaps = SquaredGaps(held_out.errors, floor.scale, channel);
  const double there = std::max(gaps.mean() - floor.Squared(channel), 0.0);
  const auto folds = FoldsOf(runs);
  for (std::size_t fold = 0; fold < kFolds; ++fold) {
    // As errors of one window whose squares these are; no more than there is to explain.
    const Eigen::VectorXd shaken = held_out.shaken[fold].cwiseMax(0.0).cwiseSqrt();
    const double explained = std::min(SquaredGaps(shaken, floor.scale, channel)[0], there);
    for (std::size_t w = 0; w < folds.size(); ++w) {
      if (folds[w] != fold) gaps[static_cast<Eigen::Index>(w)] -= explained;
    }
  }
  return gaps;
}

}  // namespace telltale
