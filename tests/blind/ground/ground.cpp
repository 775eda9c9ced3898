#include "ground/ground.hpp"

#include <algorithm>
#include <stdexcept>

#include "telltale/core/diagnosis/shaking.hpp"

namespace blind {
namespace {

using telltale::FreeRuns;

constexpr double kHorizonS = 5.0;

std::vector<FreeRuns> HealthyRuns(const Days& days) {
  std::vector<FreeRuns> healthy;
  for (const telltale::PreparedDataset& reference : days.references) {
    FreeRuns runs(reference, days.model.model, kHorizonS);
    if (runs.Windows() > 0) healthy.push_back(std::move(runs));
  }
  if (healthy.empty()) {
    throw std::invalid_argument("no reference has five seconds without a gap");
  }
  return healthy;
}

}  // namespace

Ground::Ground(const Days& given)
    : days(given),
      slots(telltale::SlotsOf(telltale::EffectLibrary())),
      runs(given.recording, given.model.model, kHorizonS),
      healthy_runs(HealthyRuns(given)),
      healthy(telltale::LearnHealthy(healthy_runs, given.model, slots, 1)),
      floor(telltale::FloorOf(healthy_runs, healthy.boat)) {
  if (runs.Windows() == 0) {
    throw std::invalid_argument("the recording has no five seconds without a gap");
  }
}

std::optional<double> Ground::ClosureBy(const telltale::AugmentedModel& model) const {
  const double before = SquaredGap(healthy.boat);
  if (before <= floor.SquaredLimit(telltale::kAllChannels)) return std::nullopt;
  return (before - SquaredGap(model)) / (before - floor.Squared(telltale::kAllChannels));
}

double Ground::SquaredGap(const telltale::AugmentedModel& model) const {
  const auto mean = [&](const Eigen::MatrixXd& errors) {
    return telltale::SquaredGaps(errors, floor.scale, telltale::kAllChannels).mean();
  };
  telltale::EffectFit fit;
  fit.effects = model.effects;
  const Eigen::VectorXd shaken = telltale::ShakenSquares(fit, runs, healthy.boat);
  const double gap = mean(runs.Errors(model));
  // What shakes explains no more than there is to explain, as in the report.
  const double there = std::max(gap - floor.Squared(telltale::kAllChannels), 0.0);
  return gap - std::min(mean(shaken.cwiseMax(0.0).cwiseSqrt()), there);
}

telltale::AugmentedModel Ground::With(const std::vector<telltale::ModelledEffect>& effects) const {
  return healthy.boat.With(effects);
}

}  // namespace blind
