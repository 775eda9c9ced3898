#include "telltale/core/diagnosis/delays/delay_difference.hpp"

#include <algorithm>
#include <cmath>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/base/square.hpp"
#include "telltale/core/diagnosis/diagnosis_constants.hpp"
#include "telltale/core/uncertainty/distributions.hpp"

namespace telltale {
namespace {

// The half-normal prior is negligible beyond ten standard deviations.
constexpr double kWidestInPriors = 10.0;
constexpr int kNodes = 400;
constexpr int kBisections = 40;

/// The delay of one more nominal day where days scatter by a given standard deviation.
struct Component {
  double weight = 0.0;  // posterior probability of that scatter, once they add up to one
  double mean_s = 0.0;
  double variance = 0.0;
};

/// Weight as the likelihood of the references times the prior, up to a constant.
Component Given(double between_s, const std::vector<DelayEstimate>& references) {
  double precision = 0.0;
  double weighted = 0.0;
  double log_weight = -0.5 * Square(between_s / kDiagnosis.delays.between_days_sd_s);
  for (const DelayEstimate& reference : references) {
    const double variance = Square(reference.standard_error_s) + Square(between_s);
    precision += 1.0 / variance;
    weighted += reference.delay_s / variance;
    log_weight -= 0.5 * std::log(variance);
  }
  Component component;
  component.mean_s = weighted / precision;
  for (const DelayEstimate& reference : references) {
    const double variance = Square(reference.standard_error_s) + Square(between_s);
    log_weight -= 0.5 * Square(reference.delay_s - component.mean_s) / variance;
  }
  component.weight = log_weight - 0.5 * std::log(precision);
  component.variance = Square(between_s) + 1.0 / precision;
  return component;
}

/// One more nominal day: a mixture over the scatter between days.
class NominalDay {
 public:
  explicit NominalDay(const std::vector<DelayEstimate>& references) {
    const double step_s = kWidestInPriors * kDiagnosis.delays.between_days_sd_s / kNodes;
    for (int i = 0; i < kNodes; ++i) components_.push_back(Given((i + 0.5) * step_s, references));
    const double largest = std::ranges::max(components_, {}, &Component::weight).weight;
    double sum = 0.0;
    for (Component& component : components_) {
      component.weight = std::exp(component.weight - largest);
      sum += component.weight;
    }
    for (Component& component : components_) component.weight /= sum;
  }

  double MeanS() const {
    double mean_s = 0.0;
    for (const Component& component : components_) mean_s += component.weight * component.mean_s;
    return mean_s;
  }

  /// Of the estimate of a recording with such a standard error.
  double VarianceOf(double standard_error_s) const {
    const double mean_s = MeanS();
    double variance = Square(standard_error_s);
    for (const Component& component : components_) {
      variance += component.weight * (component.variance + Square(component.mean_s - mean_s));
    }
    return variance;
  }

  /// The probability density of an estimate, a normal fault of so much variance included.
  double Density(const DelayEstimate& estimate, double fault_variance) const {
    double density = 0.0;
    for (const Component& component : components_) {
      const double variance =
          component.variance + Square(estimate.standard_error_s) + fault_variance;
      density += component.weight / std::sqrt(variance) *
                 std::exp(-0.5 * Square(estimate.delay_s - component.mean_s) / variance);
    }
    return density;
  }

 private:
  std::vector<Component> components_;
};

double ScoreOf(DelayedChannel channel, const DelayEstimate& estimate, const NominalDay& nominal) {
  constexpr double kLeastDensity = 1e-300;
  const EffectParameter& parameter = EffectOf(channel).Parameters().front();
  const double fault_sd_s = kDiagnosis.effect_fit.prior_width * parameter.typical;
  return 2.0 * std::log(std::max(nominal.Density(estimate, 0.0), kLeastDensity) /
                        nominal.Density(estimate, Square(fault_sd_s)));
}

/// The smallest fault that shows as often as a detectable size does.
std::optional<double> DetectableOf(DelayedChannel channel, double standard_error_s,
                                   const NominalDay& nominal) {
  const double mean_s = nominal.MeanS();
  const auto score_of = [&](double difference_s) {
    return ScoreOf(channel, {mean_s + difference_s, standard_error_s}, nominal);
  };
  double shows_not = 0.0;
  double shows = EffectOf(channel).Parameters().front().upper;
  const double chance_s = NormalQuantile(kDiagnosis.testability.power) *
                          std::sqrt(nominal.VarianceOf(standard_error_s));
  if (score_of(shows) > -kDiagnosis.ranking.material_score) return std::nullopt;
  const double largest = shows;
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (shows_not + shows);
    (score_of(middle) > -kDiagnosis.ranking.material_score ? shows_not : shows) = middle;
  }
  if (shows + chance_s > largest) return std::nullopt;
  return shows + chance_s;
}

}  // namespace

const Effect& EffectOf(DelayedChannel channel) {
  const Effect* effect =
      FindEffect(channel == DelayedChannel::kCommands ? "thruster_delay" : "gnss_latency");
  Require(effect != nullptr, "an effect that a delay is");
  return *effect;
}

DelayDifference DelayDifferenceOf(DelayedChannel channel, const DelayEstimate& recording,
                                  const std::vector<DelayEstimate>& nominal) {
  Require(!nominal.empty(), "a nominal day");
  const NominalDay day(nominal);
  return {channel, recording.delay_s - day.MeanS(),
          std::sqrt(day.VarianceOf(recording.standard_error_s)), ScoreOf(channel, recording, day),
          DetectableOf(channel, recording.standard_error_s, day)};
}

std::vector<DelayDifference> DelayDifferencesOf(const ComparedDelays& delays,
                                                std::optional<std::size_t> without) {
  std::vector<DelayDifference> differences;
  if (!delays.recording) return differences;
  for (std::size_t channel = 0; channel < kDelayedChannels.size(); ++channel) {
    std::vector<DelayEstimate> nominal;
    for (std::size_t i = 0; i < delays.references.size(); ++i) {
      if (i == without || !delays.references[i]) continue;
      nominal.push_back((*delays.references[i])[channel]);
    }
    if (nominal.size() < kDiagnosis.delays.least_references) return {};
    differences.push_back(
        DelayDifferenceOf(kDelayedChannels[channel], (*delays.recording)[channel], nominal));
  }
  return differences;
}

bool IsLate(const DelayDifference& difference) {
  return difference.difference_s > 0.0 && difference.score < -kDiagnosis.ranking.material_score;
}

}  // namespace telltale
