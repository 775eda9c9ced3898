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

const std::vector<CatalogueManoeuvre>& ManoeuvreCatalogue() {
  constexpr CommandRange kAhead = {{0.0, 0.0}, {1.0, 1.0}};
  constexpr CommandRange kStarboardAstern = {{0.1, -0.7}, {0.9, -0.1}};
  constexpr CommandRange kPortAstern = {{-0.7, 0.1}, {-0.1, 0.9}};
  constexpr double kThirdS = kCatalogueDurationS / 3;
  const auto whole = [](const Manoeuvre& manoeuvre) {
    return Repeated(manoeuvre, kCatalogueDurationS);
  };
  static const std::vector<CatalogueManoeuvre> catalogue = {
      {"surge steps", "both thrusters at 0.2 and 0.9 in turn, 4 s each",
       whole(SurgeSteps(0.2, 0.9, 1, 4.0))},
      {"staircase", "both thrusters from 0.1 to 1 in six steps and down again, 6 s each",
       whole(SurgeStaircase(0.1, 1.0, 7, 6.0))},
      {"zigzag", "0.8 on one side and 0.3 on the other, changing sides every 6 s",
       whole(Zigzag(0.55, 0.5, 1, 6.0))},
      {"zigzag at two speeds",
       "changing sides every 5 s, a minute with 0.5 against 0.2 and one with 1 against 0.5",
       Joined({Repeated(Zigzag(0.35, 0.3, 1, 5.0), kCatalogueDurationS / 2),
               Repeated(Zigzag(0.75, 0.5, 1, 5.0), kCatalogueDurationS / 2)})},
      {"fast zigzag", "full ahead on one side and 0.2 on the other, changing sides every 3 s",
       whole(Zigzag(0.6, 0.8, 1, 3.0))},
      {"circles at two speeds",
       "half a minute each: 0.5 against 0.2 to starboard and to port, then 1 against 0.5",
       Joined({Circle(0.35, 0.3, 30.0), Circle(0.35, -0.3, 30.0), Circle(0.75, 0.5, 30.0),
               Circle(0.75, -0.5, 30.0)})},
      {"spiral", "a mean of 0.5, the difference from -0.6 to 0.6 in six steps and back, 9 s each",
       whole(Spiral(0.5, 0.6, 7, 9.0))},
      {"spins", "thrusters against each other, 8 s to each side at 0.3 and then at 0.5",
       whole(Joined({Spins(0.3, 8.0), Spins(0.5, 8.0)}))},
      {"short spins", "thrusters against each other at 0.5, 3 s to each side, and 4 s at rest",
       whole(Joined({Spins(0.5, 3.0), Coast(4.0)}))},
      {"coasting", "both thrusters at 0.8 for 10 s, then none for 14 s",
       whole(Joined({SurgeSteps(0.8, 0.8, 1, 5.0), Coast(14.0)}))},
      {"turns with one side astern",
       "random steps of 1.6 to 4 s, one side astern at up to 0.7, a minute to either side",
       Joined({RandomSteps(kStarboardAstern, 1.6, 4.0, kCatalogueDurationS / 2, 1),
               RandomSteps(kPortAstern, 1.6, 4.0, kCatalogueDurationS / 2, 2)})},
      {"random steps ahead", "each thruster between rest and full ahead, random steps of 1 to 4 s",
       RandomSteps(kAhead, 1.0, 4.0, kCatalogueDurationS, 3)},
      {"random steps ahead and turning",
       "random steps of 1 to 4 s: 40 s ahead, 40 s with each side astern in turn",
       Joined({RandomSteps(kAhead, 1.0, 4.0, kThirdS, 4),
               RandomSteps(kStarboardAstern, 1.0, 4.0, kThirdS, 5),
               RandomSteps(kPortAstern, 1.0, 4.0, kThirdS, 6)})},
  };
  return catalogue;
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
