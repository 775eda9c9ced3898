#pragma once

#include <array>
#include <cstdint>

#include "telltale/core/base/gauss_markov.hpp"
#include "telltale/core/base/random.hpp"
#include "telltale/core/data/north_east_frame.hpp"
#include "telltale/core/data/samples.hpp"
#include "telltale/core/simulation/simulator.hpp"
#include "telltale/core/vessel/vehicle.hpp"

namespace telltale {

/// A boat of `telltale load`, in gusts, whose two commands change at random every few seconds.
/// Model: the mean of the priors of its vehicle, docs/concepts/physical-model.md. Sensors: white
/// noise of 0.05 m north and east and of 0.3 degrees.
class LoadBoat {
 public:
  /// At rest at `origin`. Requires: step_s > 0.
  LoadBoat(const Vehicle& vehicle, const FrameOrigin& origin, std::uint64_t seed, double step_s);

  void Step();

  /// What its sensors read now, and its commands, at `time_s`.
  GnssFix Fix(double time_s);
  HeadingSample Heading(double time_s);
  ThrusterSample Commands(double time_s) const;

 private:
  void DrawCommands();

  Vehicle vehicle_;
  VesselModel model_;
  VesselState state_;
  double step_s_;
  NorthEastFrame frame_;
  RandomEngine random_;
  WhiteSource white_;
  std::array<GaussMarkov, 3> gusts_;  ///< accelerations of surge, sway, yaw
  PropellerCommand command_;
  double held_for_s_ = 0.0;  ///< until the next command
};

}  // namespace telltale
