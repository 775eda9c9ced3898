#include "telltale/core/simulation/manoeuvre_catalogue.hpp"

namespace telltale {

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

}  // namespace telltale
