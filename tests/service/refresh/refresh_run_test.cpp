#include "telltale/service/refresh/refresh_run.hpp"

#include <gtest/gtest.h>

namespace telltale {
namespace {

RefreshedVehicle In(const std::string& vehicle_id, RefreshState state) {
  return {vehicle_id, state, 0, PromotionVerdict::kUnknown, ""};
}

TEST(RefreshRun, EndsOnceEveryVehicleIsThrough) {
  RefreshRun run("id", {"a", "b"});
  EXPECT_EQ(run.TakeChanges().size(), 2u);
  EXPECT_EQ(run.NextWaiting()->vehicle_id, "a");
  run.Update(In("a", RefreshState::kRunning));
  EXPECT_EQ(run.running(), 1u);
  EXPECT_EQ(run.NextWaiting()->vehicle_id, "b");
  run.Update(In("a", RefreshState::kRefused));
  run.Update(In("a", RefreshState::kPublished));  // too late
  run.Update(In("stranger", RefreshState::kFailed));
  EXPECT_EQ(run.running(), 0u);
  EXPECT_FALSE(run.finished());
  run.Update(In("b", RefreshState::kUnchanged));
  EXPECT_TRUE(run.finished());
  EXPECT_EQ(run.vehicles()[0].state, RefreshState::kRefused);
  EXPECT_EQ(run.TakeChanges().size(), 2u);
  EXPECT_TRUE(run.TakeChanges().empty());
}

TEST(RefreshRun, LetsAVehicleWaitAgain) {
  RefreshRun run("id", {"a", "b"});
  run.Update(In("a", RefreshState::kRunning));
  run.Update(In("b", RefreshState::kRunning));
  EXPECT_EQ(run.NextWaiting(), nullptr);
  run.Update(In("a", RefreshState::kWaiting));
  EXPECT_EQ(run.running(), 1u);
  EXPECT_EQ(run.NextWaiting()->vehicle_id, "a");
}

TEST(RefreshRun, CancelsWhatWaits) {
  RefreshRun run("id", {"a", "b", "c"});
  run.Update(In("a", RefreshState::kRunning));
  run.CancelWaiting();
  EXPECT_EQ(run.NextWaiting(), nullptr);
  EXPECT_FALSE(run.finished());
  run.Update(In("a", RefreshState::kPublished));
  EXPECT_TRUE(run.finished());
  EXPECT_EQ(run.vehicles()[2].state, RefreshState::kCancelled);
}

TEST(RefreshRun, OfNoVehicleHasEnded) {
  EXPECT_TRUE(RefreshRun("id", {}).finished());
}

}  // namespace
}  // namespace telltale
