#include "simulation/manoeuvres.hpp"

#include <algorithm>
#include <cmath>

#include <boost/random/uniform_real_distribution.hpp>

#include "contract.hpp"
#include "random.hpp"

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

std::vector<TimedCommand> SampleMission(std::uint64_t seed) {
  constexpr CommandRange kAhead = {{0.0, 0.0}, {1.0, 1.0}};
  constexpr CommandRange kToStarboard = {{0.05, -0.6}, {0.9, -0.05}};
  constexpr CommandRange kToPort = {{-0.6, 0.05}, {-0.05, 0.9}};
  constexpr CommandRange kAstern = {{-0.8, -0.8}, {-0.1, -0.1}};
  const auto random = [&](const CommandRange& range, double shortest_s, double longest_s,
                          double duration_s, std::uint64_t index) {
    return RandomSteps(range, shortest_s, longest_s, duration_s,
                       RandomEngine::Stream(seed, index)());
  };
  return Schedule(
      {
          SurgeStaircase(0.2, 1.0, 5, 6.0),         //  54 s
          Zigzag(0.5, 0.4, 3, 5.0),                 //  30 s
          SurgeSteps(0.4, 1.0, 5, 3.0),             //  30 s
          Circle(0.4, 0.4, 12.0),                   //  12 s
          Circle(0.4, -0.4, 12.0),                  //  12 s
          random(kAhead, 1.0, 3.0, 80.0, 0),        //  80 s
          Spins(0.3, 8.0),                          //  16 s
          Zigzag(0.7, 0.6, 3, 4.0),                 //  24 s
          random(kToStarboard, 1.0, 3.0, 40.0, 1),  //  40 s
          random(kToPort, 1.0, 3.0, 40.0, 2),       //  40 s
          Coast(8.0),                               //   8 s
          Circle(0.7, 0.5, 12.0),                   //  12 s
          Circle(0.7, -0.5, 12.0),                  //  12 s
          Spins(0.5, 8.0),                          //  16 s
          SurgeSteps(0.0, 0.5, 7, 2.0),             //  28 s
          SurgeSteps(0.4, 0.8, 6, 2.0),             //  24 s
          random(kAhead, 3.0, 8.0, 28.0, 3),        //  28 s
          random(kAstern, 1.0, 3.0, 12.0, 4),       //  12 s
          SurgeSteps(0.0, 1.0, 8, 2.0),             //  32 s
          random(kToStarboard, 2.0, 5.0, 20.0, 5),  //  20 s
          random(kToPort, 2.0, 5.0, 20.0, 6),       //  20 s
          random(kAhead, 1.0, 2.0, 40.0, 7),        //  40 s
          Coast(10.0),                              //  10 s
      },
      0.0);
}

}  // namespace telltale
