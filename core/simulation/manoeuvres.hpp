#pragma once

#include <cstdint>
#include <vector>

#include "telltale/core/simulation/simulator.hpp"
#include "telltale/core/vessel/propellers.hpp"

namespace telltale {

/// A command and how long it is held.
struct HeldCommand {
  PropellerCommand delta;
  double duration_s = 0.0;
};

/// Held commands, one after the other.
using Manoeuvre = std::vector<HeldCommand>;

/// Both propellers alike, up through evenly spaced levels from `low` to `high` and down again.
Manoeuvre SurgeStaircase(double low, double high, int levels, double hold_s);

/// Both propellers alike, `low` then `high`, `cycles` times: surge accelerating and braking.
Manoeuvre SurgeSteps(double low, double high, int cycles, double hold_s);

/// Port ahead of starboard by `difference` about `mean`, then the other way round, `cycles` times.
Manoeuvre Zigzag(double mean, double difference, int cycles, double hold_s);

/// One command held: to starboard when `difference` (port minus starboard) is positive, else to
/// port.
Manoeuvre Circle(double mean, double difference, double duration_s);

/// Propellers against each other (FR, or RF when `delta` is negative), then the other way round.
Manoeuvre Spins(double delta, double hold_s);

/// Both propellers stopped.
Manoeuvre Coast(double duration_s);

/// The spiral test: held commands from a turn to port to one to starboard and back. It shows
/// whether a boat has a stable straight course.
Manoeuvre Spiral(double mean, double widest_difference, int levels, double hold_s);

/// The manoeuvres one after the other.
Manoeuvre Joined(const std::vector<Manoeuvre>& manoeuvres);

/// A manoeuvre repeated and cut off after `duration_s`. Requires: it takes time.
Manoeuvre Repeated(const Manoeuvre& manoeuvre, double duration_s);

/// A box of commands: each propeller's range.
struct CommandRange {
  PropellerCommand low;
  PropellerCommand high;
};

/// Pseudo-random steps: each propeller uniform in its range, each hold uniform between the two
/// durations. Commands come in twentieths and holds in fifths of a second, so that the pulse widths
/// and instants a log holds are the true ones.
Manoeuvre RandomSteps(const CommandRange& range, double shortest_s, double longest_s,
                      double duration_s, std::uint64_t seed);

/// Manoeuvres one after the other from time `start_s`.
std::vector<TimedCommand> Schedule(const std::vector<Manoeuvre>& manoeuvres, double start_s);

}  // namespace telltale
