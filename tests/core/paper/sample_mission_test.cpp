#include "telltale/core/paper/sample_mission.hpp"

#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/paper/yellowfish.hpp"

namespace telltale {
namespace {

TEST(SampleMission, SpendsEnoughTimeInEveryRegion) {
  const auto commands = SampleMission(1);
  std::map<PropellerRegion, double> seconds;
  for (std::size_t i = 0; i < commands.size(); ++i) {
    const double end_s = i + 1 < commands.size() ? commands[i + 1].time_s : kSampleMissionDurationS;
    ASSERT_GT(end_s, commands[i].time_s);
    ASSERT_LE(std::abs(commands[i].delta.port), 1.0 + 1e-12);
    ASSERT_LE(std::abs(commands[i].delta.starboard), 1.0 + 1e-12);
    seconds[RegionOf(commands[i].delta)] += end_s - commands[i].time_s;
  }
  EXPECT_GT(seconds[PropellerRegion::kFF], 300.0);
  EXPECT_GT(seconds[PropellerRegion::kFR], 60.0);
  EXPECT_GT(seconds[PropellerRegion::kRF], 60.0);
  EXPECT_GT(seconds[PropellerRegion::kRR], 10.0);
}

TEST(SampleMission, SeparatesEveryCoefficientOfTheSimulatedBoat) {
  // Columns scaled to unit length, one row a fifth of a second. A condition number of c lets a
  // relative error of e in the data grow to c e in the worst combination of coefficients.
  const auto track = Simulate(YellowfishTwin(), {}, SampleMission(1), kSampleMissionDurationS, 0.2);
  for (const Equation equation : kEquations) {
    const auto columns = Regressors(equation, Parameterization::kPropeller).size();
    Eigen::MatrixXd phi(track.size(), columns);
    std::vector<double> row(columns);
    for (std::size_t k = 0; k < track.size(); ++k) {
      FillRow(equation, Parameterization::kPropeller, track[k].state.nu, track[k].delta, row);
      phi.row(k) = Eigen::Map<const Eigen::RowVectorXd>(row.data(), columns);
    }
    phi.colwise().normalize();
    const Eigen::VectorXd singular = phi.jacobiSvd().singularValues();
    EXPECT_LT(singular[0] / singular[singular.size() - 1], 60.0) << Name(equation);
  }
}

TEST(SampleMission, KeepsTheSimulatedBoatWithinItsSpeeds) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const auto track =
        Simulate(YellowfishTwin(), {}, SampleMission(seed), kSampleMissionDurationS, 0.05);
    for (const TimedState& at : track) {
      ASSERT_LT(std::abs(at.state.nu.u), 1.6) << "seed " << seed << " at " << at.time_s;
      ASSERT_LT(std::abs(at.state.nu.v), 1.2) << "seed " << seed << " at " << at.time_s;
      ASSERT_LT(std::abs(at.state.nu.r), 1.5) << "seed " << seed << " at " << at.time_s;
    }
  }
}

}  // namespace
}  // namespace telltale
