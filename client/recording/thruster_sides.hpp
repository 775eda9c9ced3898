#pragma once

#include <vector>

#include "telltale/core/data/samples.hpp"

namespace telltale {

/// A command of one thruster.
struct SideCommand {
  double time_s = 0.0;
  double pulse_us = 0.0;
};

/// Two channels of commands as one: each command of either side makes a sample with what the other
/// side was told last, and commands of one time make one sample. Nothing before both have begun.
std::vector<ThrusterSample> JoinSides(const std::vector<SideCommand>& port,
                                      const std::vector<SideCommand>& starboard);

/// The pulse of a share of full thrust, [-1, 1]: 1500 + 400 share us, which is what a vehicle file
/// that is not given says. Where a recording holds shares, its vehicle file repeats these numbers.
inline constexpr double kShareNeutralUs = 1500.0;
inline constexpr double kShareFullUs = 400.0;
inline double PulseOfShare(double share) {
  return kShareNeutralUs + kShareFullUs * share;
}

}  // namespace telltale
