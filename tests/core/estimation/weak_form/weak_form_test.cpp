#include "telltale/core/estimation/weak_form/weak_form.hpp"

#include <gtest/gtest.h>

#include "support/stable_boat.hpp"
#include "telltale/core/data/preparation.hpp"
#include "telltale/core/estimation/weak_form/projection.hpp"

namespace telltale {
namespace {

PrepareOptions Narrow() {
  PrepareOptions options;
  options.smoothing_half_width = 4;
  return options;
}

TEST(TestFunction, HasItsOwnSlopeAndIntegratesByParts) {
  const TestFunction phi = TestFunction::On(0.1, {});
  ASSERT_EQ(phi.Rows(), 39U);  // 2 s to each side, both ends zero and left out
  EXPECT_EQ(phi.stride, 10U);
  EXPECT_NEAR(phi.slope.sum(), 0.0, 1e-12);
  // int phi' t dt = -int phi dt. The sum of a function with five derivatives that vanish at the
  // ends is off by O(h^6).
  double moment = 0.0;
  for (Eigen::Index i = 0; i < phi.slope.size(); ++i) {
    moment += phi.slope[i] * 0.1 * static_cast<double>(i);
  }
  EXPECT_NEAR(moment, -phi.value.sum(), 1e-6);
  // int (1 - s^2)^6 ds over [-1, 1] = 2^13 6!^2 / 13!, times T.
  EXPECT_NEAR(phi.value.sum(), 2.0 * 8192.0 * 518400.0 / 6227020800.0, 1e-6);
}

TEST(TestFunction, SpansAtLeastFivePeriodsToEachSide) {
  EXPECT_EQ(TestFunction::On(1.0, {}).Rows(), 9U);
}

// With linear damping alone the filter commutes with the equation of motion, so that the weak form
// holds whatever the filter does to the velocities.
TEST(WeakForm, HoldsForALinearBoatOnAStraightCourse) {
  VesselModel model = testing::StableBoat();
  for (Eigen::VectorXd& theta : model.theta) theta.setZero();
  model.theta[0] << 0.0, 0.0, 0.0, -0.4, 0.05, 0.5, 0.3, 0.0, 0.0;
  const Manoeuvre steps = SurgeSteps(0.2, 0.9, 8, 3.0);
  VesselState start;
  start.nu.u = 0.5;
  Recording recording = Measure(Simulate(model, start, Schedule({steps}, 0.0), 48.0, 0.01),
                                testing::StableBoatVehicle(), testing::NoNoise());
  const auto dataset = Prepare(recording, testing::StableBoatVehicle(), Narrow());
  ASSERT_TRUE(dataset.has_value());
  const WeakProblem problem = BuildWeakForm(*dataset, {}, {});
  const FilteredThrust thrust = FilterThrust(*dataset, problem, std::nullopt);
  const TestFunctionSupports& supports = problem.supports[0];
  ASSERT_GT(supports.first_rows.size(), 30U);
  const Eigen::VectorXd b = ProjectAcceleration(problem, supports, *dataset, Equation::kSurge);
  const Eigen::MatrixXd G = ProjectRegressors(*dataset, problem, thrust, Equation::kSurge);
  // The sum over rows of 0.2 s stands for an integral whose velocities have a kink at each of the
  // commands' steps: (h / T)^2 = 1 % of what a step does to a window.
  EXPECT_LT((b - G * model.theta[0]).norm(), 0.01 * b.norm());
}

TEST(WeakForm, KeepsSupportsInsideSegmentsAndEnteringRows) {
  const Recording recording =
      testing::SimulateStableBoat(testing::StableBoat(), 120.0, testing::NoNoise(), 3);
  PrepareOptions options = Narrow();
  options.longest_segment_s = 40.0;
  const auto dataset = Prepare(recording, testing::StableBoatVehicle(), options);
  ASSERT_TRUE(dataset.has_value());
  ASSERT_EQ(dataset->segments.size(), 3U);
  RegressionOptions paper;
  paper.parameterization = Parameterization::kPaper;
  const WeakProblem problem = BuildWeakForm(*dataset, paper, {});
  for (const Equation equation : kEquations) {
    const TestFunctionSupports& supports = problem.supports[IndexOf(equation)];
    ASSERT_FALSE(supports.first_rows.empty());
    for (const std::size_t first : supports.first_rows) {
      const bool inside = std::any_of(
          dataset->segments.begin(), dataset->segments.end(), [&](const RowRange& segment) {
            return first >= segment.begin + options.smoothing_half_width &&
                   first + problem.phi.Rows() + options.smoothing_half_width <= segment.end;
          });
      EXPECT_TRUE(inside) << first;
      for (std::size_t k = first; k < first + problem.phi.Rows(); ++k) {
        EXPECT_TRUE(Enters(dataset->rows[k].region, equation, paper));
      }
    }
    EXPECT_EQ(supports.clusters.back().end, supports.first_rows.size());
    EXPECT_EQ(supports.clusters.size(), problem.clusters);
  }
}

TEST(SmoothingFor, WidensWithTheNoiseOfPositions) {
  const auto width = [](double noise_m, double duration_s) {
    SensorOptions sensors;
    sensors.position_noise_m = noise_m;
    const Recording recording =
        testing::SimulateStableBoat(testing::StableBoat(), duration_s, sensors, 5);
    return SmoothingFor(*Prepare(recording, testing::StableBoatVehicle(), {}));
  };
  EXPECT_EQ(width(0.005, 200.0), 4U);   // 0.8 s of a period of 0.2 s
  EXPECT_EQ(width(0.005, 1000.0), 8U);  // 1.6 s
  EXPECT_GT(width(0.2, 200.0), width(0.02, 200.0));
}

}  // namespace
}  // namespace telltale
