#include "telltale/core/paper/sample_mission.hpp"

#include "telltale/core/base/random.hpp"

namespace telltale {

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
