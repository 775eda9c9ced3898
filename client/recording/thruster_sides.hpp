#pragma once

#include <functional>
#include <vector>

#include "telltale/core/data/samples.hpp"
#include "telltale/core/vessel/side.hpp"

namespace telltale {

/// A command of one thruster.
struct SideCommand {
  double time_s = 0.0;
  double pulse_us = 0.0;
};

/// Joins commands of both sides, in the order of their times, one by one. A sample goes out once
/// both sides have been told at its time, or at the next command of another time.
class SideJoiner {
 public:
  using Emit = std::function<void(const ThrusterSample&)>;

  void Take(Side side, const SideCommand& command, const Emit& emit);

  /// Emits the sample that waits for its other side.
  void Finish(const Emit& emit);

 private:
  struct Told {
    double pulse_us = 0.0;
    bool ever = false;
    bool now = false;  ///< at the time that waits
  };

  double waiting_s_ = 0.0;
  Told port_;
  Told starboard_;
};

/// Two channels of commands as one: each command of either side makes a sample with what the other
/// side was told last, and commands of one time make one sample. Nothing before both have begun.
/// Where the clock of both was set back, by more than a minute, each side begins anew.
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
