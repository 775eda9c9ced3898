#include "telltale/service/jobs/computation.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace telltale {
namespace {

using ::testing::ElementsAre;

int NiceOfThisThread() {
  return getpriority(PRIO_PROCESS, static_cast<id_t>(gettid()));
}

/// The nice values of the thread that computes and of the one that reports.
struct NiceValues {
  int computes = 0;
  int reports = 0;

  explicit NiceValues(Urgency urgency) {
    const Computation computation(urgency, [this](auto, double) { reports = NiceOfThisThread(); });
    computes = computation([](const Progress& progress) {
      progress("computing", 0.5);
      return NiceOfThisThread();
    });
  }
};

// The share of the processors that is left to it follows from the difference to the daemon's own
// value. Of setpriority(2): 19 is the largest.
TEST(Computation, GivesWayWhereSomethingElseIsMoreUrgent) {
  for (const int own : {0, 3}) {
    std::jthread([own] {
      setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), own);
      const int now = NiceOfThisThread();  // a test that runs at a greater one stays there
      EXPECT_EQ(NiceValues(Urgency::kInteractive).computes, now);
      EXPECT_EQ(NiceValues(Urgency::kRefresh).computes, std::min(now + 10, 19));
      EXPECT_EQ(NiceValues(Urgency::kBackground).computes, 19);
    });
  }
}

// A thread that gets no processor would hold whatever it locks to report.
TEST(Computation, IsReportedByAThreadThatDoesNotGiveWay) {
  for (const Urgency urgency : kUrgencies) {
    EXPECT_EQ(NiceValues(urgency).reports, NiceOfThisThread());
  }
}

TEST(Computation, ReportsEveryStageInItsOrder) {
  for (const Urgency urgency : kUrgencies) {
    std::vector<std::string> stages;
    const Computation computation(urgency, [&](std::string_view stage, double fraction) {
      if (fraction == 1.0) stages.emplace_back(stage);
    });
    computation([](const Progress& progress) {
      for (const char* stage : {"prepare", "estimate", "assess"}) {
        for (const double fraction : {0.0, 0.5, 1.0}) progress(stage, fraction);
      }
    });
    EXPECT_THAT(stages, ElementsAre("prepare", "estimate", "assess"));
  }
}

TEST(Computation, EndsByWhatItsReportThrows) {
  for (const Urgency urgency : kUrgencies) {
    const Computation computation(
        urgency, [](std::string_view, double) { throw std::runtime_error("nobody waits"); });
    const auto compute = [](const Progress& progress) {
      for (;;) progress("computing", 0.5);
    };
    try {
      computation(compute);
      ADD_FAILURE() << "it ended";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "nobody waits");
    }
  }
}

TEST(Computation, ThrowsWhatWasThrownInIt) {
  for (const Urgency urgency : kUrgencies) {
    const Computation computation(urgency, [](std::string_view, double) {});
    EXPECT_THROW(computation([](const Progress&) { throw std::out_of_range("thrown"); }),
                 std::out_of_range);
  }
}

}  // namespace
}  // namespace telltale
