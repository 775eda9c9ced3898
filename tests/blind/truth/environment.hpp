#pragma once

#include <array>
#include <span>
#include <vector>

#include "scenario.hpp"

namespace blind::truth {

struct Place {
  double north_m = 0.0;
  double east_m = 0.0;
  double heading_rad = 0.0;
};

struct BodyForce {
  double x_n = 0.0;
  double y_n = 0.0;
  double n_nm = 0.0;
};

/// What air and water do at one place and moment.
struct Surroundings {
  double wind_north_mps = 0.0;
  double wind_east_mps = 0.0;
  double current_north_mps = 0.0;
  double current_east_mps = 0.0;
  BodyForce waves = {};
  double shoal = 0.0;  // drag gained, as a share
};

/// One day's air and water as drawn: phases, gusts and bursts. The scenario scales them, so that a
/// change of scenario on the way changes their size and not their course.
class Environment {
 public:
  explicit Environment(RandomStream rng);
  void Advance(const Weather& weather, double dt_s);
  Surroundings At(const Scenario& scenario, const Place& place, double time_s) const;
  /// Whether weed is in the propeller, which it is for that share of the time.
  bool Weedy(double weed_share, double time_s) const;

 private:
  struct Component {
    double detuning;  // frequency over that of the peak
    double phase;
    double turn;  // from the mean direction, in standard deviations
  };

  struct Spell {
    double end_s;
    double threshold;  // uniform in [0, 1): weed is caught below its share
  };

  BodyForce Waves(const Weather& weather, const Place& place, double time_s) const;
  BodyForce Wash(double force_n, const Place& place, double time_s) const;

  std::array<Component, 9> swell_{};
  // So many that their mean direction is within 3 degrees of the sea's.
  std::array<Component, 96> wind_sea_{};
  std::vector<double> wash_starts_s_;
  std::vector<Spell> spells_;
  double wash_towards_;
  double shear_towards_;
  double shear_across_;
  double shoal_across_;
  double front_m_;  // where the front lies, across
  RandomStream rng_;
  double gust_ = 0.0;           // in standard deviations
  double current_north_ = 0.0;  // likewise
  double current_east_ = 0.0;
};

}  // namespace blind::truth
