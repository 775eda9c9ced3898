#include "telltale/core/estimation/weak_form/instruments.hpp"

#include <gtest/gtest.h>

#include "support/stable_boat.hpp"
#include "telltale/core/data/preparation.hpp"
#include "telltale/core/estimation/weak_form/weak_iv.hpp"

namespace telltale {
namespace {

/// Measured without noise and smoothed over twice so many rows.
PreparedDataset SimulatedDataset(std::size_t half_width) {
  PrepareOptions options;
  options.smoothing_half_width = half_width;
  options.longest_segment_s = 60.0;
  return *Prepare(testing::SimulateStableBoat(testing::StableBoat(), 600.0, testing::NoNoise(), 11),
                  testing::StableBoatVehicle(), options);
}

/// How the true boat's equations fail on its own windows, by equation, root mean square: with
/// regressors as measured, and with what filtering before multiplying has lost of them.
struct Failures {
  Eigen::Vector3d measured;
  Eigen::Vector3d completed;
};

Failures FailuresOf(const PreparedDataset& dataset, const VesselModel& model) {
  const WeakProblem problem = BuildWeakForm(dataset, {}, {});
  const auto columns = AllColumns(Parameterization::kPropeller);
  const FilteredThrust thrust = FilterThrust(dataset, problem, std::nullopt);
  const auto predicted = Instruments(dataset, problem)
                             .Predict(model, std::vector<ConstantDisturbance>(1), columns, thrust);
  Failures failures;
  for (std::size_t j = 0; j < columns.size(); ++j) {
    const Eigen::MatrixXd G = ProjectRegressors(dataset, problem, thrust, kEquations[j]);
    const Eigen::VectorXd b =
        ProjectAcceleration(problem, problem.supports[j], dataset, kEquations[j]);
    const auto rms = [](const Eigen::VectorXd& e) {
      return e.norm() / std::sqrt(static_cast<double>(e.size()));
    };
    const Eigen::VectorXd theta = testing::StableBoat().theta[j];
    failures.measured[static_cast<Eigen::Index>(j)] = rms(b - G * theta);
    failures.completed[static_cast<Eigen::Index>(j)] =
        rms(b - (G + predicted[j].filtering_loss) * theta);
  }
  return failures;
}

// What is left is that of commands written down ten times a second.
TEST(Instruments, AccountForTheFilteringLoss) {
  const Failures failures = FailuresOf(SimulatedDataset(16), testing::StableBoat());
  EXPECT_LT(5.0 * failures.completed[1], failures.measured[1]);
  EXPECT_LT(5.0 * failures.completed[2], failures.measured[2]);
}

// A model that is off by a fifth foretells the loss well enough to take most of it off.
TEST(Instruments, AccountForMostOfTheLossWithAWrongModel) {
  VesselModel off = testing::StableBoat();
  for (Eigen::VectorXd& theta : off.theta) theta *= 0.8;
  const Failures failures = FailuresOf(SimulatedDataset(16), off);
  EXPECT_LT(2.0 * failures.completed[2], failures.measured[2]);
}

TEST(Instruments, LoseNothingOfWhatIsLinear) {
  const PreparedDataset dataset = SimulatedDataset(10);
  const WeakProblem problem = BuildWeakForm(dataset, {}, {});
  const auto predicted = Instruments(dataset, problem)
                             .Predict(testing::StableBoat(), std::vector<ConstantDisturbance>(1),
                                      AllColumns(Parameterization::kPropeller),
                                      FilterThrust(dataset, problem, std::nullopt));
  for (const Eigen::Index j : {6, 7, 8, 9, 10, 11, 12}) {  // v, r, 1 and thrust
    EXPECT_LT(predicted[1].filtering_loss.col(j).norm(), 1e-9 * predicted[1].Z.col(j).norm());
  }
}

// Where one equation lacks a support, the two are projected separately.
TEST(Instruments, ServeSwayAndYawAlikeTogetherOrApart) {
  const PreparedDataset dataset = SimulatedDataset(8);
  WeakProblem problem = BuildWeakForm(dataset, {}, {});
  const FilteredThrust thrust = FilterThrust(dataset, problem, std::nullopt);
  const auto predict = [&] {
    return Instruments(dataset, problem)
        .Predict(testing::StableBoat(), std::vector<ConstantDisturbance>(1),
                 {{{0, 3}, {0, 4, 8, 12}, {1, 4, 12}}}, thrust);
  };
  const auto together = predict();
  problem.supports[1].first_rows.pop_back();
  const auto apart = predict();
  ASSERT_EQ(apart[1].Z.rows() + 1, apart[2].Z.rows());
  EXPECT_EQ(together[1].Z.topRows(apart[1].Z.rows()), apart[1].Z);
  EXPECT_EQ(together[1].filtering_loss.topRows(apart[1].filtering_loss.rows()),
            apart[1].filtering_loss);
  EXPECT_EQ(together[2].Z, apart[2].Z);
  EXPECT_EQ(together[2].filtering_loss, apart[2].filtering_loss);
  EXPECT_EQ(together[1].Z.col(1), together[2].Z.col(1));  // both of uv
}

}  // namespace
}  // namespace telltale
