#include "telltale/core/estimation/regression/recording_bias_terms.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "telltale/core/vessel/disturbance.hpp"

namespace telltale {
namespace {

TEST(RecordingBiasTerms, AreNoneWhereOneConstantIsShared) {
  EXPECT_EQ((RecordingBiasTerms{RecordingBiasModel::kShared, 4}.Count()), 0u);
  EXPECT_EQ((RecordingBiasTerms{RecordingBiasModel::kPerRecording, 4}.Count()), 4u);
  EXPECT_EQ((RecordingBiasTerms{RecordingBiasModel::kPerRecordingNorthEast, 4}.Count()), 12u);
}

TEST(RecordingBiasTerms, StandUnderTheirOwnRecording) {
  std::array<double, 6> row{};
  row.fill(7.0);
  const RecordingBiasTerms terms{RecordingBiasModel::kPerRecordingNorthEast, 2};
  terms.Fill(1, std::numbers::pi / 2.0, row);
  EXPECT_EQ(row[0], 0.0);
  EXPECT_EQ(row[3], 1.0);
  EXPECT_NEAR(row[4], 0.0, 1e-15);
  EXPECT_NEAR(row[5], 1.0, 1e-15);
}

// A force to the north: ahead on a northerly course, from starboard on an easterly one.
TEST(ConstantDisturbance, StandsInTheNorthEastFrame) {
  ConstantDisturbance north;
  north.terms << 0, 0.3, 0, 0, 0, -0.3, 0.01, 0, 0;
  EXPECT_NEAR(north.At(0.0).u, 0.3, 1e-15);
  EXPECT_NEAR(north.At(0.0).v, 0.0, 1e-15);
  EXPECT_NEAR(north.At(std::numbers::pi / 2.0).u, 0.0, 1e-15);
  EXPECT_NEAR(north.At(std::numbers::pi / 2.0).v, -0.3, 1e-15);
  EXPECT_EQ(north.At(1.0).r, 0.01);
}

TEST(HeadingVaries, WhereARecordingTurnsFarEnough) {
  PreparedDataset dataset;
  for (int k = 0; k < 200; ++k) {
    PreparedRow row;
    row.eta.psi_rad = k < 100 ? 1.0 + 0.001 * k : 0.1 * k;
    dataset.rows.push_back(row);
  }
  dataset.segments = {{0, 100}, {100, 150}, {150, 200}};
  dataset.recordings = {0, 1, 1};
  EXPECT_EQ(HeadingVaries(dataset), (std::vector<bool>{false, true}));
}

}  // namespace
}  // namespace telltale
