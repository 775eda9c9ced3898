#include "telltale/core/drift/drift_test.hpp"

#include <algorithm>
#include <cmath>

#include "telltale/core/diagnosis/residuals/sensitivity.hpp"
#include "telltale/core/effects/effect.hpp"

namespace telltale {
namespace {

double ForgettingOver(double time_s) {
  return std::exp(-kDrift.window_s / time_s);
}

double PrecisionOf(double sd) {
  return 1.0 / (sd * sd);
}

Eigen::VectorXd PrecisionOfWeather() {
  Eigen::VectorXd precision(kDrift.weather.size());
  for (std::size_t i = 0; i < kDrift.weather.size(); ++i) {
    precision[static_cast<Eigen::Index>(i)] = PrecisionOf(kDrift.weather[i].prior_sd);
  }
  return precision;
}

/// Of what else makes sideslip: DriftEvidence::compass.
Eigen::VectorXd PrecisionOfSideslip() {
  const double through_water = PrecisionOf(kDrift.drift_through_water_sd);
  const double in_turns = PrecisionOf(kDrift.sideslip_in_turns_sd);
  return Eigen::Vector4d(through_water, through_water, in_turns, in_turns);
}

}  // namespace

double DriftFinding::Excess() const {
  return (std::abs(value) - tolerance) / standard_error;
}

std::string DriftFinding::Describe() const {
  return effect->Describe(At({effect, 0}, value).values);
}

DriftTest::Watched DriftTest::Watch(const WatchedChange& change,
                                    const Eigen::VectorXd& weather_precision) {
  Eigen::VectorXd precision(1 + weather_precision.size());
  precision << PrecisionOf(change.prior_sd), weather_precision;
  return {change,
          {precision, ForgettingOver(kDrift.time_constant_s)},
          {precision, ForgettingOver(kDrift.model_error_time_s)}};
}

DriftTest::DriftTest() {
  for (const WatchedChange& change : kDrift.changes) {
    watched_.push_back(Watch(change, PrecisionOfWeather()));
  }
  watched_.push_back(Watch(kDrift.compass, PrecisionOfSideslip()));
}

void DriftTest::Add(const DriftEvidence& evidence) {
  for (std::size_t j = 0; j < watched_.size(); ++j) {
    const bool is_compass = j == kDrift.changes.size();
    if (is_compass ? !evidence.turns : !evidence.is_varied) continue;
    const NormalEquations& equations = is_compass ? evidence.compass : evidence.changes[j];
    Watched& watched = watched_[j];
    watched.now.Add(equations);
    if (FindingOf(watched).Excess() <= 0.0) watched.before.Add(equations);
  }
  const auto strongest = Strongest();
  if (!strongest) return;
  if (strongest->Excess() >= kDrift.alarm_sigmas) fires_ = true;
  if (strongest->Excess() < 0.0) fires_ = false;
}

bool DriftTest::Rises() const {
  const auto strongest = Strongest();
  return strongest && strongest->Excess() > 0.0;
}

std::optional<DriftFinding> DriftTest::Strongest() const {
  std::optional<DriftFinding> strongest;
  for (const Watched& watched : watched_) {
    if (watched.now.Count() < kDrift.minimum_count) continue;
    const DriftFinding finding = FindingOf(watched);
    if (!strongest || finding.Excess() > strongest->Excess()) strongest = finding;
  }
  return strongest;
}

DriftFinding DriftTest::FindingOf(const Watched& watched) {
  const WatchedChange& change = watched.change;
  const double before = std::clamp(watched.before.Value(), -change.model_error, change.model_error);
  return {FindEffect(change.effect), watched.now.Value() - before, watched.now.StandardError(),
          change.tolerance};
}

}  // namespace telltale
