// Two recordings of one boat in the daemon's window, parted by a long silence.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "service/service_fixture.hpp"
#include "support/stable_boat.hpp"
#include "telltale/client/recording/file_contents.hpp"
#include "telltale/idl/codec/json/model.hpp"

namespace telltale {
namespace {

using LiveRecordingBias = ServiceTest;

TEST_F(LiveRecordingBias, AreThoseOfEachRecordingThatTheWindowHolds) {
  const auto daemon = StartDaemon();
  Replay(SimulatedRecording(testing::StableBoat(), 0.0, 300.0, 4));
  Replay(SimulatedRecording(testing::StableBoat(), 500.0, 300.0, 5));
  const auto file = folder_.Path() / "model.json";
  const auto identify = Start({"identify", "--vehicle-id", kVehicleId, "--recording-bias",
                               "per-recording", "--out", file, "--timeout", "120"});
  ASSERT_EQ(identify->Wait(), 0) << identify->output();
  const auto model = ParseModelJson(*ReadFile(file));
  ASSERT_TRUE(model) << model.error().Message();
  EXPECT_EQ(model->estimator, Estimator::kWeakIv);
  ASSERT_EQ(model->recording_bias.size(), 2u);
  EXPECT_LT(model->recording_bias[0].end_s, 301.0);
  EXPECT_GT(model->recording_bias[1].start_s, 499.0);
  for (const RecordingBias& recording_bias : model->recording_bias) {
    EXPECT_EQ(recording_bias.coefficients.size(), 3u);  // the constant of each equation
  }
}

TEST_F(LiveRecordingBias, AreNotForAnEstimatorThatKnowsNone) {
  const auto daemon = StartDaemon();
  const auto identify = Start({"identify", "--vehicle-id", kVehicleId, "--recording-bias",
                               "per-recording", "--estimator", "one-step"});
  EXPECT_EQ(identify->Wait(), 2);
  EXPECT_THAT(identify->output(), ::testing::HasSubstr("not estimated by one-step"));
}

}  // namespace
}  // namespace telltale
