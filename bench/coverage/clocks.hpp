#pragma once

#include <algorithm>

#include "telltale/core/data/samples.hpp"

namespace telltale::coverage {

/// When samples are taken and what their stamps say.
struct Clocks {
  double command_period_s = 0.1;   ///< of the recorded commands
  bool sampled = false;            ///< commands change between their stamps as well
  bool steered = false;            ///< an autopilot changes them at 50 Hz
  double command_delay_s = 0.0;    ///< a command acts this long after its stamp
  double least_fix_delay_s = 0.0;  ///< a fix is stamped this late, uniform in a range
  double greatest_fix_delay_s = 0.0;
  double jitter_s = 0.0;  ///< of every stamp, one sigma
};

/// Jitter may swap the stamps of neighbours, which no log keeps in that order.
inline void PutInOrder(Recording& recording) {
  std::ranges::stable_sort(recording.gnss, {}, &GnssFix::time_s);
  std::ranges::stable_sort(recording.heading, {}, &HeadingSample::time_s);
  std::ranges::stable_sort(recording.thrusters, {}, &ThrusterSample::time_s);
}

}  // namespace telltale::coverage
