#include "telltale/core/identification/model_comparison.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <boost/random/normal_distribution.hpp>

#include "support/discrete_boat.hpp"
#include "telltale/core/identification/identify.hpp"
#include "telltale/core/paper/yellowfish.hpp"

namespace telltale {
namespace {

/// A run of the boat with noise in what drives it, which biases nothing.
Identification RunOf(const VesselModel& model, std::uint64_t seed,
                     const IdentifyOptions& options = IdentifyOptions::OneStep()) {
  const auto commands = testing::RandomCommands(
      6000, {PropellerRegion::kFF, PropellerRegion::kFR, PropellerRegion::kRF}, seed);
  RandomEngine engine(seed);
  boost::random::normal_distribution<double> noise(0.0, 0.02);
  PreparedDataset dataset = testing::DriveDiscrete(model, commands, 50);
  Nu nu;
  for (std::size_t k = 0; k < dataset.rows.size(); ++k) {
    dataset.rows[k].nu = nu;
    const NuDot rate = model.Acceleration(nu, dataset.rows[k].delta);
    const double h = model.sampling_period_s;
    nu = {nu.u + h * (rate.u + noise(engine)), nu.v + h * (rate.v + noise(engine)),
          nu.r + h * (rate.r + noise(engine))};
  }
  return Identify(dataset, "boat", options).value();
}

/// Six pairs of runs of one boat: at 0.1 % a false alarm among them has a chance of 0.6 %.
TEST(ModelComparison, FindsOneBoatLikeItself) {
  for (std::uint64_t pair = 1; pair <= 6; ++pair) {
    const auto test =
        TestForChange(RunOf(YellowfishTwin(), pair), RunOf(YellowfishTwin(), 100 + pair));
    ASSERT_TRUE(test) << test.error().reason;
    EXPECT_EQ(test->degrees_of_freedom, 32u);  // of 35, three being steady disturbances
    EXPECT_GT(test->p_value, 0.001) << pair;
  }
}

/// Half as much surge drag again is found, and found in surge.
TEST(ModelComparison, FindsAFouledHull) {
  VesselModel fouled = YellowfishTwin();
  const auto surge = Regressors(Equation::kSurge, fouled.parameterization);
  for (std::size_t j = 0; j < surge.size(); ++j) {
    if (surge[j].name == "u" || surge[j].name == "u|u|") {
      fouled.theta[0][static_cast<Eigen::Index>(j)] *= 1.5;
    }
  }
  const Identification clean = RunOf(YellowfishTwin(), 1);
  const auto test = TestForChange(clean, RunOf(fouled, 2));
  ASSERT_TRUE(test);
  EXPECT_LT(test->p_value, 1e-4);
  EXPECT_EQ(clean.coefficients[test->differences[0].index].equation, Equation::kSurge);
}

TEST(ModelComparison, ComparesTheEquationsBothHave) {
  Identification surge_alone = RunOf(YellowfishTwin(), 1);
  std::erase_if(surge_alone.coefficients,
                [](const Coefficient& c) { return c.equation != Equation::kSurge; });
  surge_alone.covariance = Eigen::MatrixXd(surge_alone.covariance.topLeftCorner(9, 9));
  const Identification whole = RunOf(YellowfishTwin(), 2);
  const auto test = TestForChange(whole, surge_alone);
  ASSERT_TRUE(test);
  EXPECT_EQ(test->degrees_of_freedom, 8u);
  EXPECT_NEAR(TestForChange(surge_alone, whole)->statistic, test->statistic,
              1e-8 * test->statistic);
}

/// A time constant five of its errors away, all else alike: it alone differs, and by that much.
TEST(ModelComparison, ComparesTheThrusterTimeConstant) {
  Identification first = RunOf(YellowfishTwin(), 1);
  first.structure = Structure::kFirstOrderDynamic;
  first.provenance.bootstrap_replicates = 0;
  first.thruster_time_constant = Coefficient{};
  first.thruster_time_constant->estimate = 0.5;
  first.thruster_time_constant->standard_error = 0.01;
  first.time_constant_covariance = Eigen::VectorXd::Zero(first.covariance.rows());
  Identification second = first;
  second.thruster_time_constant->estimate += 5.0 * std::sqrt(2.0) * 0.01;
  const auto test = TestForChange(first, second);
  ASSERT_TRUE(test);
  EXPECT_EQ(test->degrees_of_freedom, 33u);
  EXPECT_NEAR(test->statistic, 25.0, 1e-9);
  EXPECT_EQ(test->differences[0].index, first.coefficients.size());
}

TEST(ModelComparison, RefusesModelsWhoseCoefficientsMeanDifferentThings) {
  const Identification first = RunOf(YellowfishTwin(), 1);
  Identification second = first;
  second.sampling_period_s *= 2.0;
  second.structure = Structure::kFirstOrderDynamic;
  const auto refused = TestForChange(first, second);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().reason, "the models differ in structure, sampling period");
}

}  // namespace
}  // namespace telltale
