#include "telltale/core/diagnosis/residuals/frequency_response.hpp"

#include <cmath>
#include <numbers>

#include "telltale/core/base/linear_algebra/covariance.hpp"
#include "telltale/core/diagnosis/diagnosis_constants.hpp"

namespace telltale {
namespace {

/// Gauss-Hermite quadrature of a normal law.
struct Node {
  double deviations = 0.0;  ///< in standard deviations from the mean
  double weight = 0.0;
};
constexpr std::array<Node, 5> kNodes = {{{-2.856970, 0.01125741},
                                         {-1.355626, 0.2220759},
                                         {0.0, 0.5333333},
                                         {1.355626, 0.2220759},
                                         {2.856970, 0.01125741}}};

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

ResponseMoments MeanResponseMomentsOf(double frequency_rad_s, double log_width,
                                      const FreeRuns& runs, const AugmentedModel& boat,
                                      const Eigen::MatrixXd& errors) {
  ResponseMoments mean;
  for (Eigen::MatrixXd& axis : mean) axis = Eigen::MatrixXd::Zero(errors.rows(), errors.rows());
  for (const Node& node : kNodes) {
    const ResponseMoments moments = ResponseMomentsAt(
        frequency_rad_s * std::exp(log_width * node.deviations), runs, boat, errors);
    for (std::size_t axis = 0; axis < mean.size(); ++axis) {
      mean[axis] += node.weight * moments[axis];
    }
  }
  return mean;
}

Eigen::MatrixXd ErrorCovarianceBy(const ResponseMoments& moments,
                                  const Eigen::Vector3d& squared_amplitudes) {
  return squared_amplitudes[0] * moments[0] + squared_amplitudes[1] * moments[1] +
         squared_amplitudes[2] * moments[2];
}

}  // namespace telltale
