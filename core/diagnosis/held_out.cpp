#include "diagnosis/held_out.hpp"

#include "diagnosis/shaking.hpp"

namespace telltale {
namespace {

std::vector<std::size_t> WindowsOf(const std::vector<std::size_t>& folds, std::size_t fold) {
  std::vector<std::size_t> windows;
  for (std::size_t w = 0; w < folds.size(); ++w) {
    if (folds[w] == fold) windows.push_back(w);
  }
  return windows;
}

bool Shakes(const EffectFit& fit) {
  return SlotsOf(std::span(&fit.effects.front().effect, 1)).empty();
}

}  // namespace

std::vector<std::size_t> FoldsOf(const FreeRuns& runs) {
  std::vector<std::size_t> folds = BlocksOf(runs);
  for (std::size_t& fold : folds) fold %= kFolds;
  return folds;
}

FoldFits FitOnFolds(const EffectFit& fit, const Evidence& evidence) {
  const auto folds = FoldsOf(evidence.runs);
  std::vector<const Effect*> effects;
  std::vector<double> values;
  for (const auto& [effect, own] : fit.effects) {
    effects.push_back(effect);
    values.insert(values.end(), own.begin(), own.end());
  }
  const Eigen::VectorXd start =
      Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
  FoldFits fits;
  for (std::size_t fold = 0; fold < kFolds; ++fold) {
    const Judge judge(evidence.healthy, evidence.recording, WindowsOf(folds, fold),
                      evidence.judge.FreesBase());
    fits[fold] = Shakes(fit)
                     ? FitShaking(*effects.front(), evidence.runs, evidence.healthy, judge,
                                  evidence.recording.errors, 1)
                     : FitEffects(evidence.runs, evidence.healthy.boat, judge, effects, {start});
  }
  return fits;
}

HeldOutErrors ErrorsHeldOut(const FoldFits& fits, const FreeRuns& runs,
                            const AugmentedModel& model) {
  const auto folds = FoldsOf(runs);
  HeldOutErrors held_out;
  held_out.errors.resize(runs.Rows(), static_cast<Eigen::Index>(runs.Windows()));
  for (std::size_t fold = 0; fold < kFolds; ++fold) {
    AugmentedModel with = model;
    with.effects.insert(with.effects.end(), fits[fold].effects.begin(), fits[fold].effects.end());
    const Eigen::MatrixXd errors = runs.Errors(with);
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
  const auto folds = FoldsOf(runs);
  for (std::size_t fold = 0; fold < kFolds; ++fold) {
    // As errors of one window whose squares these are.
    const double explained =
        SquaredGaps(held_out.shaken[fold].cwiseMax(0.0).cwiseSqrt(), floor.scale, channel)[0];
    for (std::size_t w = 0; w < folds.size(); ++w) {
      if (folds[w] != fold) gaps[static_cast<Eigen::Index>(w)] -= explained;
    }
  }
  return gaps;
}

}  // namespace telltale
