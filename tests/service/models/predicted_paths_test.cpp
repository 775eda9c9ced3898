#include "telltale/service/models/predicted_paths.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "service/service_fixture.hpp"
#include "telltale/core/identification/identify.hpp"
#include "telltale/core/paper/yellowfish.hpp"

namespace telltale {
namespace {

using ::testing::HasSubstr;

constexpr double kSpanS = 60.0;
constexpr double kHorizonS = 20.0;

class PredictedPathsTest : public ::testing::Test {
 protected:
  PredictedPathsTest() {
    IdentifyOptions options;
    options.estimator = Estimator::kOneStep;
    options.parametric_replicates = 0;
    options.bootstrap_replicates = 0;
    options.advise = false;
    model = *Identify(recording, YellowfishVehicle(), options);
  }

  Result<PredictedPaths> Predict(double horizon_s = kHorizonS) const {
    return PredictPaths(recording, YellowfishVehicle(), model, kSpanS, horizon_s);
  }

  void ScaleSurge(double factor) {
    for (Coefficient& c : model.coefficients) {
      if (c.equation == Equation::kSurge) c.estimate *= factor;
    }
  }

  const Recording recording = SimulatedRecording();
  Identification model;
};

TEST_F(PredictedPathsTest, StartAtTheMeasuredPathAndCoverTheSpan) {
  const auto paths = Predict();
  ASSERT_TRUE(paths);
  ASSERT_EQ(paths->predicted.size(), 3u);
  const Path& measured = paths->measured;
  EXPECT_DOUBLE_EQ(measured.north_m.front(), 0.0);
  EXPECT_DOUBLE_EQ(measured.east_m.front(), 0.0);
  // The filters cut off less than five seconds at the end.
  EXPECT_GT(measured.time_s.back(), 115.0);
  for (const Path& run : paths->predicted) {
    const auto start = std::ranges::lower_bound(measured.time_s, run.time_s.front() - 1e-6);
    ASSERT_NE(start, measured.time_s.end());
    const auto at = static_cast<std::size_t>(start - measured.time_s.begin());
    EXPECT_NEAR(run.time_s.back() - run.time_s.front(), kHorizonS, 1e-6);
    EXPECT_NEAR(run.north_m.front(), measured.north_m[at], 1e-9);
    EXPECT_NEAR(run.east_m.front(), measured.east_m[at], 1e-9);
  }
}

// Half the thrust and half the damping is another boat.
TEST_F(PredictedPathsTest, ShowAModelOfAnotherBoat) {
  const double fitting_m = Predict()->position_rmse_m;
  ScaleSurge(0.5);
  EXPECT_GT(Predict()->position_rmse_m, 2.0 * fitting_m);
}

TEST_F(PredictedPathsTest, EndWhereTheModelDiverges) {
  ScaleSurge(-30.0);
  const auto paths = Predict();
  ASSERT_TRUE(paths);
  EXPECT_EQ(paths->position_rmse_m, std::numeric_limits<double>::infinity());
  for (const Path& run : paths->predicted) {
    for (const double north_m : run.north_m) EXPECT_TRUE(std::isfinite(north_m));
    EXPECT_LT(run.time_s.back() - run.time_s.front(), kHorizonS);
  }
}

TEST_F(PredictedPathsTest, RefuseWhereNoRunFits) {
  const auto paths = PredictPaths(recording, YellowfishVehicle(), model, 300.0, 200.0);
  ASSERT_FALSE(paths);
  EXPECT_THAT(paths.error().reason, HasSubstr("no 200 s"));
}

TEST_F(PredictedPathsTest, RefuseAModelThatLacksAnEquation) {
  std::erase_if(model.coefficients,
                [](const Coefficient& c) { return c.equation == Equation::kYaw; });
  EXPECT_FALSE(Predict());
}

}  // namespace
}  // namespace telltale
