#include "telltale/service/supervision/liveness.hpp"

#include <gtest/gtest.h>

#include "telltale/service/supervision/supervision.hpp"

namespace telltale {
namespace {

using namespace std::chrono_literals;

DaemonActivity ActivityAfter(std::uint64_t heartbeats,
                             std::chrono::steady_clock::duration silence = 0s) {
  DaemonActivity activity;
  activity.heartbeats = heartbeats;
  activity.queues = {{.queue = "identification", .silence = 1s},
                     {.queue = "diagnosis", .silence = silence}};
  return activity;
}

TEST(Liveness, NeedsTheIngestThreadToComeRound) {
  Liveness liveness;
  EXPECT_FALSE(liveness.Advances(ActivityAfter(0)));
  EXPECT_TRUE(liveness.Advances(ActivityAfter(1)));
  EXPECT_FALSE(liveness.Advances(ActivityAfter(1)));
  EXPECT_TRUE(liveness.Advances(ActivityAfter(7)));
}

TEST(Liveness, NeedsEveryWorkerToReportProgress) {
  Liveness liveness;
  EXPECT_TRUE(liveness.Advances(ActivityAfter(1, Liveness::kLongestStep - 1s)));
  EXPECT_FALSE(liveness.Advances(ActivityAfter(2, Liveness::kLongestStep)));
  EXPECT_TRUE(liveness.Advances(ActivityAfter(2, 1s)));
}

TEST(StatusLine, SaysTheRoleAndWhatWaits) {
  DaemonActivity activity;
  activity.vehicles = 12;
  activity.queues = {{.queue = "identification", .waiting = 2, .running = 1},
                     {.queue = "diagnosis", .waiting = 1}};
  EXPECT_EQ(StatusLine(activity), "starting with 12 vehicles; 3 requests wait, 1 are worked on");
  activity.is_ready = true;
  EXPECT_EQ(StatusLine(activity), "standing by for 12 vehicles; 3 requests wait, 1 are worked on");
  activity.serves = true;
  EXPECT_EQ(StatusLine(activity), "serving 12 vehicles; 3 requests wait, 1 are worked on");
}

}  // namespace
}  // namespace telltale
