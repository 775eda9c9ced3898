#include "telltale/service/supervision/liveness.hpp"

#include <chrono>

#include <gtest/gtest.h>

namespace telltale {
namespace {

using namespace std::chrono_literals;

DaemonActivity SilentFor(std::chrono::steady_clock::duration ingest,
                         std::chrono::steady_clock::duration worker) {
  DaemonActivity activity;
  activity.ingest_silence = ingest;
  activity.queues = {{.queue = "identification", .silence = 1s},
                     {.queue = "diagnosis", .silence = worker}};
  return activity;
}

TEST(Liveness, NeedsTheIngestThreadToComeRound) {
  EXPECT_TRUE(IsAlive(SilentFor(kLongestRound - 1ms, 0s)));
  EXPECT_FALSE(IsAlive(SilentFor(kLongestRound, 0s)));
}

TEST(Liveness, NeedsEveryWorkerToReportProgress) {
  EXPECT_TRUE(IsAlive(SilentFor(0s, kLongestStep - 1s)));
  EXPECT_FALSE(IsAlive(SilentFor(0s, kLongestStep)));
}

TEST(Liveness, SaysTheRoleAndWhatWaits) {
  DaemonActivity activity;
  activity.vehicles = 12;
  activity.queues = {{.queue = "identification", .waiting = 2, .running = 1},
                     {.queue = "diagnosis", .waiting = 1}};
  activity.serves = true;
  EXPECT_EQ(StatusLine(activity), "starting with 12 vehicles; 3 requests wait, 1 are worked on");
  activity.is_ready = true;
  EXPECT_EQ(StatusLine(activity), "serving 12 vehicles; 3 requests wait, 1 are worked on");
  activity.serves = false;
  EXPECT_EQ(StatusLine(activity), "standing by for 12 vehicles; 3 requests wait, 1 are worked on");
}

}  // namespace
}  // namespace telltale
