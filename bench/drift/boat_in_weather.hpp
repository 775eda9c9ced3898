#pragma once

#include <array>
#include <cstdint>

#include "telltale/core/base/gauss_markov.hpp"
#include "telltale/core/base/random.hpp"
#include "telltale/core/data/samples.hpp"
#include "telltale/core/simulation/simulator.hpp"
#include "telltale/core/vessel/vehicle.hpp"
#include "telltale/core/vessel/vessel_model.hpp"

namespace telltale::drift {

/// What is wrong with a boat; as constructed, nothing.
struct Fault {
  double port_thrust = 1.0;  ///< times what it was
  double drag = 1.0;         ///< likewise, of every damping term
  double compass_deg = 0.0;  ///< that the compass reads too high
};

/// What a boat does for an hour.
enum class Work {
  kVaried,   ///< a minute each of circles, zigzags and random steps, also with one side astern
  kTransit,  ///< one course at one thrust for twenty minutes, then another
};

/// A made-up catamaran of 1.2 m, whose coefficients are 10 % off (one sigma, log-normal) from boat
/// to boat, in gusts, wind and current, all of which change over hours.
/// Model: strength exp(s), s of 0.5 (one sigma) over two hours; wind 0.03 m/s^2 times strength from
/// a direction that turns by 1.5 rad over two hours; gusts of 0.02 m/s^2 and rad/s^2 times strength
/// over 4 s; current 0.1 m/s north and east, over two hours. A breeze pushes a boat of some 35 kg
/// with a newton. Fixes at 5 Hz with 0.02 m, headings at 10 Hz with 0.3 degrees of white noise.
class BoatInWeather {
 public:
  /// Thrust follows the commands with a first-order lag, or at once.
  explicit BoatInWeather(std::uint64_t seed, double thruster_lag_s = 0.0);

  /// The next samples of the sensors, on a clock that goes on.
  Recording Record(double duration_s, Work work, const Fault& fault = {});

 private:
  std::vector<TimedCommand> VariedCommands(double duration_s);
  PropellerCommand HoldCourse(double time_s);
  void Advance(const VesselModel& model, const PropellerCommand& delta, double port_thrust);

  VesselModel model_;
  std::array<ThrustRegressors, 2> thrust_{};  ///< of port and starboard, after the lag
  RandomEngine random_;
  std::uint64_t seed_;
  GaussMarkov strength_;
  GaussMarkov wind_direction_;
  std::array<GaussMarkov, 3> gusts_;
  std::array<GaussMarkov, 2> current_;
  VesselState state_;
  double time_s_ = 0.0;
  double course_rad_ = 0.0;
  double course_thrust_ = 0.5;
  double course_until_s_ = 0.0;
};

Vehicle VehicleInWeather();

}  // namespace telltale::drift
