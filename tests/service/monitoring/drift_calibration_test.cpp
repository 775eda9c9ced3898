// What the monitor makes of boats of which everything is known. bench/drift_rates measures how
// often, for docs/validation/monitoring.md.
#include <cstdint>
#include <ostream>
#include <string>

#include <gtest/gtest.h>

#include "drift/boat_in_weather.hpp"
#include "telltale/core/data/recording_parts.hpp"
#include "telltale/core/identification/identify.hpp"
#include "telltale/service/models/free_run_error.hpp"
#include "telltale/service/monitoring/drift_monitor.hpp"

namespace telltale::drift {
namespace {

constexpr double kIdentifiedS = 1200.0;
constexpr double kHourS = 3600.0;
constexpr double kMinuteS = 60.0;
constexpr double kGoalS = 600.0;

/// A boat whose model has just been made, and the monitor that follows it minute by minute.
class Followed {
 public:
  explicit Followed(std::uint64_t seed) : boat_(seed) {
    const Recording behind = boat_.Record(kIdentifiedS, Work::kVaried);
    IdentifyOptions options;
    options.bootstrap_replicates = 0;
    options.advise = false;
    model_ = *Identify(behind, VehicleInWeather(), options);
    normal_ = *MeasureFreeRunError(behind, VehicleInWeather(), model_);
    monitor_.Follow(behind, VehicleInWeather(), model_, normal_);
  }

  const DriftMonitor& After(double duration_s, Work work, const Fault& fault = {}) {
    const Recording recording = boat_.Record(duration_s, work, fault);
    const double begun_s = recording.gnss.front().time_s;
    for (double to_s = kMinuteS; to_s <= duration_s; to_s += kMinuteS) {
      monitor_.Follow(Between(recording, begun_s - 1.0, begun_s + to_s), VehicleInWeather(), model_,
                      normal_);
    }
    return monitor_;
  }

 private:
  BoatInWeather boat_;
  Identification model_;
  FreeRunError normal_{};
  DriftMonitor monitor_;
};

TEST(NominalDriftCalibration, FindsNothingInChangingWeatherNorOnTransits) {
  for (std::uint64_t seed = 1001; seed <= 1003; ++seed) {
    Followed boat(seed);
    for (int part = 0; part < 9; ++part) {
      const Work work = part % 3 == 2 ? Work::kTransit : Work::kVaried;
      EXPECT_FALSE(boat.After(kHourS / 3.0, work).Fires()) << seed << ", part " << part;
    }
  }
}

TEST(NominalDriftCalibration, SaysWhatItCannotTellOnATransit) {
  Followed boat(1);
  EXPECT_EQ(boat.After(kHourS / 3.0, Work::kVaried).Untested().find("thruster"), std::string::npos);
  EXPECT_EQ(
      boat.After(kHourS / 3.0, Work::kTransit).Untested(),
      "port thruster, starboard thruster, drag, compass: commands and heading vary too little");
}

struct Expected {
  const char* name;
  Fault fault;
  const char* pattern;  ///< that is named; empty: any. No watched change is more drag on every side
};

void PrintTo(const Expected& expected, std::ostream* out) {
  *out << expected.name;
}

class DriftCalibration : public ::testing::TestWithParam<Expected> {};

TEST_P(DriftCalibration, IsFoundWithinTenMinutes) {
  Followed boat(1);
  EXPECT_FALSE(boat.After(kHourS / 3.0, Work::kVaried).Fires());
  const DriftMonitor& monitor = boat.After(kGoalS, Work::kVaried, GetParam().fault);
  EXPECT_TRUE(monitor.Fires());
  EXPECT_NE(monitor.Pattern().find(GetParam().pattern), std::string::npos) << monitor.Pattern();
  ASSERT_TRUE(monitor.onset());
  EXPECT_GT(monitor.onset()->vehicle_s, kIdentifiedS + kHourS / 3.0);
}

INSTANTIATE_TEST_SUITE_P(
    Faults, DriftCalibration,
    ::testing::Values(Expected{"WeakPortThruster", {.port_thrust = 0.6}, "port thruster"},
                      Expected{"Fouling", {.drag = 1.3}, ""},
                      Expected{"CompassTooHigh", {.compass_deg = 4.0}, "heading reads"},
                      Expected{"CompassTooLow", {.compass_deg = -4.0}, "heading reads"}),
    [](const auto& expected) { return std::string(expected.param.name); });

}  // namespace
}  // namespace telltale::drift
