#include "telltale/client/twin/faults.hpp"

#include <algorithm>
#include <cstddef>

#include "telltale/core/vessel/runge_kutta.hpp"

namespace telltale {
namespace {

template <class Samples>
void JumpStamps(const TwinFaults& faults, Samples& samples) {
  for (auto& sample : samples) {
    const auto jumps = std::ranges::count_if(faults.clock_jumps_at_s,
                                             [&](double at_s) { return at_s <= sample.time_s; });
    sample.time_s += static_cast<double>(jumps) * faults.clock_jump_s;
  }
}

/// What the propellers deliver: the port one a share of its thrust.
ThrustRegressors Delivered(const VesselModel& boat, const PropellerCommand& delta,
                           double port_strength) {
  ThrustRegressors thrust = boat.SteadyThrust(delta);
  const ThrustRegressors port = boat.SteadyThrust({delta.port, 0.0});
  for (std::size_t i = 0; i < thrust.surge.size(); ++i) {
    thrust.surge[i] -= (1.0 - port_strength) * port.surge[i];
    thrust.turning[i] -= (1.0 - port_strength) * port.turning[i];
  }
  return thrust;
}

}  // namespace

std::vector<TimedState> SimulateWeak(const VesselModel& boat, const TwinFaults& faults,
                                     std::vector<TimedState> track) {
  const auto first = std::ranges::lower_bound(track, faults.weak_from_s, {}, &TimedState::time_s);
  for (auto now = first; now != track.end() && now + 1 != track.end(); ++now) {
    const double step_s = (now + 1)->time_s - now->time_s;
    const auto thrust = Delivered(boat, now->delta, faults.port_strength);
    const Nu nu = RungeKuttaStep(now->state.nu, step_s, [&](const Nu& at, StepStage) {
      return boat.AccelerationUnder(thrust, at);
    });
    (now + 1)->state.eta = NextPose(now->state.eta, now->state.nu, nu, step_s);
    (now + 1)->state.nu = nu;
  }
  return track;
}

void JumpClock(const TwinFaults& faults, Recording& recording) {
  JumpStamps(faults, recording.gnss);
  JumpStamps(faults, recording.heading);
  JumpStamps(faults, recording.thrusters);
}

}  // namespace telltale
