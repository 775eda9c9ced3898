#include "telltale/core/estimation/weak_form/weak_iv.hpp"

#include <Eigen/Eigenvalues>

#include <gtest/gtest.h>
#include <boost/random/uniform_real_distribution.hpp>

#include "support/stable_boat.hpp"
#include "telltale/core/base/linear_algebra/covariance.hpp"
#include "telltale/core/base/random.hpp"
#include "telltale/core/data/preparation.hpp"
#include "telltale/core/estimation/regression/one_step.hpp"

namespace telltale {
namespace {

PreparedDataset SimulatedDataset(const VesselModel& model, const SensorOptions& sensors,
                                 double duration_s) {
  PrepareOptions options;
  options.smoothing_half_width = 4;
  options.longest_segment_s = 60.0;
  return *Prepare(testing::SimulateStableBoat(model, duration_s, sensors, 11),
                  testing::StableBoatVehicle(), options);
}

constexpr std::array<Eigen::Index, 2> kSurgeThrust = {5, 6};

TEST(WeakIv, FindsTheBoatWithoutNoise) {
  const VesselModel boat = testing::StableBoat();
  const auto fit = EstimateWeakIv(SimulatedDataset(boat, testing::NoNoise(), 900.0), {},
                                  AllColumns(Parameterization::kPropeller), {});
  ASSERT_TRUE(fit.has_value());
  // What is left is what a filter of 1.6 s does to products of velocities.
  for (const Eigen::Index j : {0, 1, 3, 5, 6, 7, 8}) {
    EXPECT_NEAR(fit->equations[0]->theta[j], boat.theta[0][j], 0.04 * std::abs(boat.theta[0][j]));
  }
  for (const Eigen::Index j : {3, 7, 9, 10, 11, 12}) {
    EXPECT_NEAR(fit->equations[2]->theta[j], boat.theta[2][j], 0.08 * std::abs(boat.theta[2][j]));
  }
}

// One-step least squares attenuates at 5 cm and half a degree; instruments do not.
TEST(WeakIv, IsFarLessAttenuatedThanOneStepLeastSquares) {
  const VesselModel boat = testing::StableBoat();
  SensorOptions sensors;
  sensors.position_noise_m = 0.05;
  sensors.heading_noise_deg = 0.5;
  const PreparedDataset dataset = SimulatedDataset(boat, sensors, 1800.0);
  const auto weak = EstimateWeakIv(dataset, {}, AllColumns(Parameterization::kPropeller), {});
  ASSERT_TRUE(weak.has_value());
  const RegressionProblem problem = BuildRegression(dataset, {});
  const EquationEstimate one_step = EstimateOneStep(*Assess(problem.equations[0], {}));
  for (const Eigen::Index j : kSurgeThrust) {
    const double truth = boat.theta[0][j];
    const double weak_error = std::abs(weak->equations[0]->theta[j] - truth);
    EXPECT_LT(weak_error, 0.1 * std::abs(truth));
    EXPECT_LT(2.0 * weak_error, std::abs(one_step.theta[j] - truth)) << "coefficient " << j;
  }
}

TEST(WeakIv, FindsTheLagOfTheThrusters) {
  VesselModel boat = testing::StableBoat();
  boat.structure = Structure::kFirstOrderDynamic;
  boat.thruster_time_constant_s = 0.4;
  RegressionOptions regression;
  regression.structure = Structure::kFirstOrderDynamic;
  SensorOptions sensors;
  const auto fit = EstimateWeakIv(SimulatedDataset(boat, sensors, 900.0), regression,
                                  AllColumns(Parameterization::kPropeller), {});
  ASSERT_TRUE(fit.has_value());
  EXPECT_NEAR(*fit->time_constant_s, 0.4, 0.05);
  const VesselModel model = ModelOf(*fit, fit->theta, 0.2);
  EXPECT_EQ(model.structure, Structure::kFirstOrderDynamic);
  EXPECT_NEAR(model.theta[0][5], 0.45, 0.06);
}

TEST(WeakIv, LeavesOutWhatIsNotSought) {
  auto columns = AllColumns(Parameterization::kPropeller);
  columns[1].clear();
  columns[0] = {0, 3, 5, 6};
  const auto fit = EstimateWeakIv(
      SimulatedDataset(testing::StableBoat(), testing::NoNoise(), 300.0), {}, columns, {});
  ASSERT_TRUE(fit.has_value());
  EXPECT_FALSE(fit->equations[1].has_value());
  EXPECT_EQ(fit->theta.size(), 4 + 13);
  EXPECT_EQ(ModelOf(*fit, fit->theta, 0.2).theta[0][1], 0.0);
}

TEST(WeakIv, RefusesTooFewSupports) {
  EXPECT_FALSE(EstimateWeakIv(SimulatedDataset(testing::StableBoat(), testing::NoNoise(), 12.0), {},
                              AllColumns(Parameterization::kPropeller), {})
                   .has_value());
}

/// Two minutes of which a radio lost up to ten seconds now and then.
PreparedDataset SimulatedWithGaps(std::uint64_t seed) {
  Recording recording =
      testing::SimulateStableBoat(testing::StableBoat(), 120.0, SensorOptions(), seed);
  RandomEngine engine(seed);
  boost::random::uniform_real_distribution<double> heard(5.0, 20.0);
  boost::random::uniform_real_distribution<double> lost(1.5, 10.0);
  double end_s = 0.0;
  while (end_s < 120.0) {
    const double begin_s = end_s + heard(engine);
    end_s = begin_s + lost(engine);
    const auto is_lost = [&](const auto& sample) {
      return sample.time_s >= begin_s && sample.time_s < end_s;
    };
    std::erase_if(recording.gnss, is_lost);
    std::erase_if(recording.heading, is_lost);
    std::erase_if(recording.thrusters, is_lost);
  }
  PrepareOptions options;
  options.smoothing_half_width = 4;
  options.longest_segment_s = 60.0;
  return *Prepare(recording, testing::StableBoatVehicle(), options);
}

TEST(WeakIv, HasACovarianceHoweverShortAndTornTheDataAre) {
  int answered = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto fit =
        EstimateWeakIv(SimulatedWithGaps(seed), {}, AllColumns(Parameterization::kPropeller), {});
    if (!fit || fit->scores.cols() < 2) continue;
    ++answered;
    const Eigen::MatrixXd covariance = ClusterCovariance(*fit);
    ASSERT_TRUE((covariance.diagonal().array() > 0.0).all()) << seed;
    const Eigen::VectorXd sizes = covariance.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(Scaled(covariance, sizes));
    EXPECT_GT(axes.eigenvalues()[0], -1e-12) << seed;
  }
  EXPECT_GT(answered, 10);
}

}  // namespace
}  // namespace telltale
