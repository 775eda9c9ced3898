#include "telltale/core/estimation/weak_form/disturbance_estimate.hpp"

#include "telltale/core/estimation/weak_form/weak_form_columns.hpp"
#include "telltale/core/estimation/weak_form/weak_iv.hpp"

#include <gtest/gtest.h>

#include "support/stable_boat.hpp"
#include "telltale/core/data/preparation.hpp"
#include "telltale/core/simulation/synthetic_dataset.hpp"

namespace telltale {
namespace {

TEST(Disturbance, IsFoundInTheResiduals) {
  PrepareOptions options;
  options.smoothing_half_width = 4;
  options.longest_segment_s = 60.0;
  const PreparedDataset calm =
      *Prepare(testing::SimulateStableBoat(testing::StableBoat(), 3000.0, testing::NoNoise(), 21),
               testing::StableBoatVehicle(), options);
  Disturbance pushed;
  pushed.sigma << 0.03, 0.04, 0.06;
  pushed.time_constant_s << 2.0, 4.0, 3.0;
  const auto dataset = SimulateDataset(calm, testing::StableBoat(), {pushed, 1.0, 5});
  ASSERT_TRUE(dataset.has_value());
  const auto fit = EstimateWeakIv(*dataset, {}, AllColumns(Parameterization::kPropeller), {});
  ASSERT_TRUE(fit.has_value());
  const Disturbance found = EstimateDisturbance(*dataset, *fit, SensorAutocovariances());
  // 3000 s are some 400 correlation times: sigma is known to 5 %, its time constant to 15 %; what
  // the coefficients take up comes on top.
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(found.sigma[axis], pushed.sigma[axis], 0.2 * pushed.sigma[axis]);
    EXPECT_NEAR(found.time_constant_s[axis], pushed.time_constant_s[axis],
                0.4 * pushed.time_constant_s[axis]);
  }
}

TEST(Disturbance, IsNotTakenForQuickerWhereDataAreFew) {
  PrepareOptions options;
  options.smoothing_half_width = 4;
  const PreparedDataset calm =
      *Prepare(testing::SimulateStableBoat(testing::StableBoat(), 400.0, testing::NoNoise(), 22),
               testing::StableBoatVehicle(), options);
  Disturbance pushed;
  pushed.sigma << 0.03, 0.03, 0.04;
  pushed.time_constant_s.setConstant(4.0);
  constexpr int kRepeats = 40;
  // sigma^2 tau is what a constant disturbance's standard error depends on.
  Eigen::Array3d found = Eigen::Array3d::Zero();
  for (std::uint64_t seed = 1; seed <= kRepeats; ++seed) {
    const auto dataset = SimulateDataset(calm, testing::StableBoat(), {pushed, 1.0, seed});
    ASSERT_TRUE(dataset.has_value());
    const auto fit = EstimateWeakIv(*dataset, {}, AllColumns(Parameterization::kPropeller), {});
    ASSERT_TRUE(fit.has_value());
    const Disturbance one = EstimateDisturbance(*dataset, *fit, SensorAutocovariances());
    found += one.sigma.array().square() * one.time_constant_s.array() / kRepeats;
  }
  const Eigen::Array3d truth = pushed.sigma.array().square() * pushed.time_constant_s.array();
  // 400 s tell sigma^2 tau to some 35 %, 40 times 400 s to 6 %; three times that. What coefficients
  // take up, were it not allowed for, would leave 0.7 to 0.8.
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(found[axis] / truth[axis], 1.0, 0.18) << axis;
  }
}

}  // namespace
}  // namespace telltale
