#include "telltale/core/diagnosis/remainder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "telltale/core/linear_algebra/decompositions.hpp"

namespace telltale {
namespace {

constexpr double kSizes = 0.3;  // of typical ones: what a remainder may hold of each effect

/// Sizes of all slots that the remainder on the judge's windows asks for, by ridge. What scatters
/// more than in health tells less.
Eigen::VectorXd SizesIn(const Eigen::MatrixXd& errors, const Judge& judge,
                        const Sensitivity& recording) {
  const Eigen::VectorXd left = judge.See(errors);
  const Eigen::MatrixXd seen = judge.SeeColumns(recording.by_slot);
  const Eigen::MatrixXd weighed = judge.Weigh(seen);
  const double scatter = std::max(judge.Leftover(left), 1.0);
  Eigen::MatrixXd information = seen.transpose() * weighed / scatter;
  information.diagonal().array() += 1.0 / (kSizes * kSizes);
  const Eigen::VectorXd slope = weighed.transpose() * left / scatter;
  return -information.ldlt().solve(slope);
}

double LearnableIn(const Eigen::MatrixXd& errors, const EffectFit& best, const Evidence& evidence) {
  const std::array judges = {best.JudgedBy(JudgeOfFold(evidence, 0)),
                             best.JudgedBy(JudgeOfFold(evidence, 1))};
  double left = 0.0;
  double less = 0.0;
  for (std::size_t fold = 0; fold < kFolds; ++fold) {
    const Eigen::VectorXd sizes = SizesIn(errors, judges[1 - fold], evidence.recording);
    const Judge& judge = judges[fold];
    const Eigen::VectorXd seen = judge.See(errors);
    left += judge.Square(seen);
    less += judge.Square(seen + judge.SeeColumns(evidence.recording.by_slot) * sizes);
  }
  return std::log(left / less);
}

}  // namespace

Remainder RemainderOf(const EffectFit& best, const HeldOutErrors& held, const Evidence& evidence) {
  const Judge& judge = evidence.judge;
  const auto& logs = evidence.healthy.log_leftovers;
  const double mean =
      std::accumulate(logs.begin(), logs.end(), 0.0) / static_cast<double>(logs.size());
  Remainder remainder{.before = judge.Leftover(judge.See(evidence.recording.errors)),
                      .healthy = std::exp(mean)};
  // What only shakes leaves errors as they are, and windows that scatter: nothing to learn from.
  if (best.effects.back().effect->Shakes()) {
    remainder.after = best.square / judge.Expected();
    return remainder;
  }
  const Judge allowing = best.JudgedBy(judge);
  remainder.after = allowing.Leftover(allowing.See(held.errors));
  remainder.learnable = LearnableIn(held.errors, best, evidence);
  return remainder;
}

}  // namespace telltale
