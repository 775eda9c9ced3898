#include "telltale/core/simulation/sensors.hpp"

#include <algorithm>
#include <cmath>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/base/degrees.hpp"
#include "telltale/core/base/gauss_markov.hpp"
#include "telltale/core/data/north_east_frame.hpp"
#include "telltale/core/data/time_series.hpp"

namespace telltale {
namespace {

double Between(double a, double b, double fraction) {
  return a + fraction * (b - a);
}

Eta Between(const Eta& a, const Eta& b, double fraction) {
  return {Between(a.x_m, b.x_m, fraction), Between(a.y_m, b.y_m, fraction),
          Between(a.psi_rad, b.psi_rad, fraction)};
}

// Calls sense(time, pose, command) at every period along the track.
template <class Sense>
void Sample(const std::vector<TimedState>& track, double period_s, Sense sense) {
  Require(period_s > 0.0, "a positive sensor period");
  if (track.empty()) return;
  const double start_s = track.front().time_s;
  const double span_s = track.back().time_s - start_s + kSameInstantS;
  std::size_t at = 0;
  for (std::size_t k = 0; static_cast<double>(k) * period_s <= span_s; ++k) {
    const double time_s = start_s + static_cast<double>(k) * period_s;
    while (at + 1 < track.size() && track[at + 1].time_s <= time_s + kSameInstantS) ++at;
    const TimedState& before = track[at];
    const TimedState& after = track[std::min(at + 1, track.size() - 1)];
    const double gap_s = after.time_s - before.time_s;
    const double fraction = gap_s > 0.0 ? (time_s - before.time_s) / gap_s : 0.0;
    sense(time_s, Between(before.state.eta, after.state.eta, fraction), before.delta);
  }
}

std::vector<GnssFix> MeasurePositions(const std::vector<TimedState>& track, const LeverArm& antenna,
                                      const SensorOptions& options) {
  const NorthEastFrame frame(options.origin);
  WhiteSource north_noise(options.seed, 0);
  WhiteSource east_noise(options.seed, 1);
  std::vector<GnssFix> fixes;
  Sample(track, options.gnss_period_s, [&](double time_s, const Eta& eta, const PropellerCommand&) {
    const double c = std::cos(eta.psi_rad);
    const double s = std::sin(eta.psi_rad);
    const double north = eta.x_m + c * antenna.forward_m - s * antenna.starboard_m +
                         options.position_noise_m * north_noise();
    const double east = eta.y_m + s * antenna.forward_m + c * antenna.starboard_m +
                        options.position_noise_m * east_noise();
    const GeographicPosition fix = frame.Inverse({north, east});
    fixes.push_back({time_s, fix.latitude_deg, fix.longitude_deg});
  });
  return fixes;
}

std::vector<HeadingSample> MeasureHeadings(const std::vector<TimedState>& track,
                                           const SensorOptions& options) {
  WhiteSource noise(options.seed, 2);
  std::vector<HeadingSample> headings;
  Sample(track, options.heading_period_s,
         [&](double time_s, const Eta& eta, const PropellerCommand&) {
           headings.push_back({time_s, Wrap360(eta.psi_rad * kDegreesPerRadian +
                                               options.heading_noise_deg * noise())});
         });
  return headings;
}

std::vector<ThrusterSample> MeasureCommands(const std::vector<TimedState>& track,
                                            const Vehicle& vehicle, double period_s) {
  std::vector<ThrusterSample> samples;
  Sample(track, period_s, [&](double time_s, const Eta&, const PropellerCommand& delta) {
    samples.push_back({time_s, std::round(vehicle.port.PulseWidth(delta.port)),
                       std::round(vehicle.starboard.PulseWidth(delta.starboard))});
  });
  return samples;
}

}  // namespace

Recording Measure(const std::vector<TimedState>& track, const Vehicle& vehicle,
                  const SensorOptions& options) {
  Recording recording;
  recording.gnss = MeasurePositions(track, vehicle.gnss_antenna, options);
  recording.heading = MeasureHeadings(track, options);
  recording.thrusters = MeasureCommands(track, vehicle, options.thruster_period_s);
  return recording;
}

}  // namespace telltale
