#include "telltale/service/models/free_run_error.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "drift/boat_in_weather.hpp"
#include "telltale/core/identification/identify.hpp"

namespace telltale {
namespace {

TEST(PredictionError, IsOneWhereNothingChangedAndScalesWithTheError) {
  const FreeRunError reference{0.1, 0.2, 0.3};
  EXPECT_DOUBLE_EQ(RelativeError(reference, reference), 1.0);
  EXPECT_DOUBLE_EQ(RelativeError({0.3, 0.6, 0.9}, reference), 3.0);
  EXPECT_DOUBLE_EQ(RelativeError({0.2, 0.2, 0.3}, reference), std::sqrt(2.0));
}

TEST(PredictionError, IsNoneOfAModelThatDiverges) {
  drift::BoatInWeather boat(1);
  const Recording recording = boat.Record(120.0, drift::Work::kVaried);
  IdentifyOptions options;
  options.bootstrap_replicates = 0;
  options.advise = false;
  auto identified =
      Identify(boat.Record(1200.0, drift::Work::kVaried), drift::VehicleInWeather(), options);
  ASSERT_TRUE(identified);
  EXPECT_TRUE(MeasureFreeRunError(recording, drift::VehicleInWeather(), *identified));
  // Damping that drives: speeds grow twentythousandfold in 5 s, yet stay finite.
  identified->simulation.clear();
  for (Coefficient& coefficient : identified->coefficients) {
    if (coefficient.regressor == "u|u|") coefficient.estimate = 0.0;
    if (coefficient.regressor == "u") coefficient.estimate = 2.0;
  }
  EXPECT_FALSE(MeasureFreeRunError(recording, drift::VehicleInWeather(), *identified));
}

}  // namespace
}  // namespace telltale
