#include "telltale/core/diagnosis/residuals/frequency_response.hpp"

#include <cmath>
#include <numbers>
#include <string>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/base/linear_algebra/covariance.hpp"
#include "telltale/core/base/parallel.hpp"
#include "telltale/core/diagnosis/diagnosis_constants.hpp"

namespace telltale {
namespace {

constexpr std::size_t kFrequencies = kDiagnosis.linearisation.frequencies;

/// An acceleration along one axis, of one frequency and phase.
class HarmonicAcceleration final : public Effect {
 public:
  HarmonicAcceleration(std::size_t axis, double frequency_rad_s, double phase_rad)
      : Effect({.name = "harmonic_acceleration",
                .title = "",
                .equation = "",
                .source = "",
                .parameters = {},
                .settled_by = "",
                .hook = Hook::kAcceleration}),
        axis_(axis),
        frequency_rad_s_(frequency_rad_s),
        phase_rad_(phase_rad) {}

  std::string Describe(EffectValues) const override { return ""; }

  NuDot AddedAcceleration(EffectValues, const InstantState& instant) const override {
    const double push = kAcceleration * std::cos(frequency_rad_s_ * instant.time_s + phase_rad_);
    return {axis_ == 0 ? push : 0.0, axis_ == 1 ? push : 0.0, axis_ == 2 ? push : 0.0};
  }

  static constexpr double kAcceleration = kDiagnosis.linearisation.harmonic_acceleration;

 private:
  std::size_t axis_;
  double frequency_rad_s_;
  double phase_rad_;
};

}  // namespace

ResponseMoments ResponseMomentsAt(double frequency_rad_s, const FreeRuns& runs,
                                  const AugmentedModel& boat, const Eigen::MatrixXd& errors) {
  const auto windows = static_cast<double>(errors.cols());
  ResponseMoments patterns;
  for (std::size_t axis = 0; axis < patterns.size(); ++axis) {
    patterns[axis] = Eigen::MatrixXd::Zero(errors.rows(), errors.rows());
    for (const double phase : {0.0, -std::numbers::pi / 2.0}) {
      const HarmonicAcceleration harmonic(axis, frequency_rad_s, phase);
      const ModelledEffect stochastic{&harmonic, {}};
      const Eigen::MatrixXd response =
          (runs.Errors(boat.With({&stochastic, 1})) - errors) / HarmonicAcceleration::kAcceleration;
      patterns[axis] += 0.5 / windows * OfRoot(response);
    }
  }
  return patterns;
}

FrequencyResponse::FrequencyResponse(std::span<const Effect* const> library, const FreeRuns& runs,
                                     const AugmentedModel& boat, const Eigen::MatrixXd& errors,
                                     std::size_t threads) {
  for (const Effect* effect : library) {
    if (!effect->IsStochastic()) continue;
    const auto parameters = effect->Parameters();
    Require(parameters.size() == 4, "three amplitudes and a frequency");
    const auto [lower, upper] = std::pair(parameters[3].lower, parameters[3].upper);
    std::vector<Band>& bands = bands_[effect];
    bands.resize(kFrequencies);
    ForEachIndex(kFrequencies, threads, [&](std::size_t i) {
      const double share = static_cast<double>(i) / static_cast<double>(kFrequencies - 1);
      bands[i].frequency_rad_s = lower * std::pow(upper / lower, share);
      bands[i].patterns = ResponseMomentsAt(bands[i].frequency_rad_s, runs, boat, errors);
    });
  }
}

}  // namespace telltale
