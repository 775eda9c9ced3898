#include "telltale/core/simulation/manoeuvres.hpp"

#include <algorithm>
#include <cmath>

#include <boost/random/uniform_real_distribution.hpp>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/base/random.hpp"

namespace telltale {
namespace {

constexpr double kCommandGrid = 0.05;
constexpr double kHoldGridS = 0.2;

double Uniform(RandomEngine& engine, double low, double high, double grid) {
  if (low == high) return low;
  const double drawn = boost::random::uniform_real_distribution<double>(low, high)(engine);
  return grid * std::round(drawn / grid);
}

PropellerCommand About(double mean, double difference) {
  return {mean + difference / 2, mean - difference / 2};
}

}  // namespace

Manoeuvre SurgeStaircase(double low, double high, int levels, double hold_s) {
  Require(levels >= 2, "two levels or more");
  Manoeuvre up;
  for (int i = 0; i < levels; ++i) {
    const double delta = low + (high - low) * i / (levels - 1);
    up.push_back({{delta, delta}, hold_s});
  }
  Manoeuvre staircase = up;
  staircase.insert(staircase.end(), up.rbegin() + 1, up.rend());
  return staircase;
}

Manoeuvre SurgeSteps(double low, double high, int cycles, double hold_s) {
  Manoeuvre steps;
  for (int i = 0; i < cycles; ++i) {
    steps.push_back({{low, low}, hold_s});
    steps.push_back({{high, high}, hold_s});
  }
  return steps;
}

Manoeuvre Zigzag(double mean, double difference, int cycles, double hold_s) {
  Manoeuvre zigzag;
  for (int i = 0; i < cycles; ++i) {
    zigzag.push_back({About(mean, difference), hold_s});
    zigzag.push_back({About(mean, -difference), hold_s});
  }
  return zigzag;
}

Manoeuvre Circle(double mean, double difference, double duration_s) {
  return {{About(mean, difference), duration_s}};
}

Manoeuvre Spins(double delta, double hold_s) {
  return {{{delta, -delta}, hold_s}, {{-delta, delta}, hold_s}};
}

Manoeuvre Coast(double duration_s) {
  return {{{0.0, 0.0}, duration_s}};
}

Manoeuvre Spiral(double mean, double widest_difference, int levels, double hold_s) {
  Require(levels >= 2, "two levels or more");
  Manoeuvre across;
  for (int i = 0; i < levels; ++i) {
    const double share = 2.0 * i / (levels - 1) - 1.0;
    across.push_back({About(mean, share * widest_difference), hold_s});
  }
  Manoeuvre spiral = across;
  spiral.insert(spiral.end(), across.rbegin() + 1, across.rend());
  return spiral;
}

Manoeuvre Joined(const std::vector<Manoeuvre>& manoeuvres) {
  Manoeuvre joined;
  for (const Manoeuvre& manoeuvre : manoeuvres) {
    joined.insert(joined.end(), manoeuvre.begin(), manoeuvre.end());
  }
  return joined;
}

Manoeuvre Repeated(const Manoeuvre& manoeuvre, double duration_s) {
  Require(std::any_of(manoeuvre.begin(), manoeuvre.end(),
                      [](const HeldCommand& held) { return held.duration_s > 0.0; }),
          "a manoeuvre that takes time");
  Manoeuvre repeated;
  for (double left_s = duration_s; left_s > 0.0;) {
    for (const HeldCommand& held : manoeuvre) {
      if (left_s <= 0.0) break;
      repeated.push_back({held.delta, std::min(held.duration_s, left_s)});
      left_s -= held.duration_s;
    }
  }
  return repeated;
}

Manoeuvre RandomSteps(const CommandRange& range, double shortest_s, double longest_s,
                      double duration_s, std::uint64_t seed) {
  Require(shortest_s >= kHoldGridS && longest_s >= shortest_s,
          "holds of a fifth of a second or more");
  RandomEngine engine(seed);
  Manoeuvre steps;
  for (double left_s = duration_s; left_s > kHoldGridS / 2;) {
    const double port = Uniform(engine, range.low.port, range.high.port, kCommandGrid);
    const double starboard =
        Uniform(engine, range.low.starboard, range.high.starboard, kCommandGrid);
    const double hold_s = Uniform(engine, shortest_s, longest_s, kHoldGridS);
    steps.push_back({{port, starboard}, std::min(hold_s, left_s)});
    left_s -= hold_s;
  }
  return steps;
}

std::vector<TimedCommand> Schedule(const std::vector<Manoeuvre>& manoeuvres, double start_s) {
  std::vector<TimedCommand> commands;
  double time_s = start_s;
  for (const Manoeuvre& manoeuvre : manoeuvres) {
    for (const HeldCommand& held : manoeuvre) {
      commands.push_back({time_s, held.delta});
      time_s += held.duration_s;
    }
  }
  return commands;
}

}  // namespace telltale
