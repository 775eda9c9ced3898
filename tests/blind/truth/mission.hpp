#pragma once

#include <functional>
#include <vector>

#include "hull.hpp"
#include "motion.hpp"
#include "random_stream.hpp"

namespace blind::truth {

/// Shares of full command, [-1, 1].
struct Command {
  double port = 0.0;
  double starboard = 0.0;
};

/// One manoeuvre: what to command so long after its start, given how the boat moves.
struct Manoeuvre {
  double duration_s;
  std::function<Command(double since_s, const State& state)> steer;
};

/// Manoeuvres one after the other, neutral behind the last.
class Mission {
 public:
  explicit Mission(std::vector<Manoeuvre> manoeuvres) : manoeuvres_(std::move(manoeuvres)) {}
  /// Times are asked for in ascending order.
  Command At(double time_s, const State& state);

 private:
  std::vector<Manoeuvre> manoeuvres_;
  std::size_t current_ = 0;
  double start_s_ = 0.0;
};

/// A mission of the set's own mix, at least `duration_s` long. Development: random steps, timed
/// zigzags, staircases, circles, legs, spins, coasting, fast steps. Held-out: ramps between random
/// set points, zigzags by heading, figures of eight, boxes, spirals, sweeps, bursts out of rest,
/// braking.
Mission DrawnMission(Set set, double duration_s, RandomStream rng);

}  // namespace blind::truth
