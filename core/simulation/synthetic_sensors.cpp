#include "telltale/core/simulation/synthetic_sensors.hpp"

#include <algorithm>
#include <cmath>

#include "telltale/core/base/degrees.hpp"

namespace telltale {
namespace {

constexpr std::uint64_t kFirstDriftStream = 20;
// GNSS drift is bounded: a first-order process of this time constant, far longer than the windows
// in which the data could show it.
constexpr double kDriftTimeConstantS = 30.0;
// Preparation averages headings over a row. The mean of five behaves like that of a faster sensor
// to a twentieth of the variance that averaging removes; the mean of two would leave half as much
// again.
constexpr double kHeadingsPerRow = 5.0;

/// The share of white noise's variance that remains in the mean of a linearly interpolated signal
/// over `samples` sampling intervals: whole weights within, halves at both ends.
double VarianceAfterAveraging(double samples) {
  return samples < 2.0 ? 1.0 : (samples - 0.5) / (samples * samples);
}

/// The drift of fixes along one axis, from its size within a second.
GaussMarkov DriftProcess(double within_a_second_m, double step_s, WhiteSource source) {
  const double sigma_m = within_a_second_m * std::sqrt(0.5 * kDriftTimeConstantS);
  return {sigma_m, kDriftTimeConstantS, step_s, source};
}

}  // namespace

SyntheticSensors::SyntheticSensors(const PreparedDataset& dataset,
                                   const SyntheticDatasetOptions& options)
    : sensors_(dataset.sensors),
      frame_(dataset.origin),
      north_(options.seed, 0),
      east_(options.seed, 1),
      heading_(options.seed, 2),
      drift_north_(DriftProcess(options.disturbance.gnss_drift_m, sensors_.gnss_period_s,
                                WhiteSource(options.seed, kFirstDriftStream))),
      drift_east_(DriftProcess(options.disturbance.gnss_drift_m, sensors_.gnss_period_s,
                               WhiteSource(options.seed, kFirstDriftStream + 1))) {
  const double shortest_s = dataset.sampling_period_s / kHeadingsPerRow;
  heading_period_s_ = std::max(sensors_.heading_period_s, shortest_s);
  position_noise_m_ = options.noise_scale * sensors_.position_noise_m;
  heading_noise_rad_ =
      options.noise_scale * sensors_.heading_noise_rad *
      std::sqrt(VarianceAfterAveraging(dataset.sampling_period_s / sensors_.heading_period_s) /
                VarianceAfterAveraging(dataset.sampling_period_s / heading_period_s_));
}

void SyntheticSensors::Record(const SimulatedSegment& segment, const SyntheticTrack& track,
                              Recording& recording) {
  const double end_s = segment.start_s + segment.Duration() + 1e-6;
  for (std::size_t i = 0;; ++i) {
    const double t = segment.start_s + static_cast<double>(i) * sensors_.gnss_period_s;
    if (t > end_s) break;
    recording.gnss.push_back(Fix(t, track.At(t)));
  }
  for (std::size_t i = 0;; ++i) {
    const double t = segment.start_s + static_cast<double>(i) * heading_period_s_;
    if (t > end_s) break;
    const double psi = track.HeadingAt(t) + heading_noise_rad_ * heading_();
    recording.heading.push_back({t, WrapAngle(psi) * kDegreesPerRadian});
  }
  const HeldCommands& commands = segment.Commands();
  const PwmChannel pwm;
  for (std::size_t i = 0; i < commands.Times().size(); ++i) {
    const double t = commands.Times()[i] + segment.shift_s;
    if (t > end_s + 1.0) break;
    const PropellerCommand& delta = commands.Commands()[i];
    recording.thrusters.push_back({t, pwm.PulseWidth(delta.port), pwm.PulseWidth(delta.starboard)});
  }
}

GnssFix SyntheticSensors::Fix(double t, const Eta& eta) {
  const double c = std::cos(eta.psi_rad);
  const double s = std::sin(eta.psi_rad);
  const LeverArm& arm = sensors_.antenna;
  const double north = eta.x_m + c * arm.forward_m - s * arm.starboard_m +
                       position_noise_m_ * north_() + drift_north_.Next();
  const double east = eta.y_m + s * arm.forward_m + c * arm.starboard_m +
                      position_noise_m_ * east_() + drift_east_.Next();
  const GeographicPosition place = frame_.Inverse({north, east});
  return {t, place.latitude_deg, place.longitude_deg};
}

}  // namespace telltale
