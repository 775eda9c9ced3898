#include "telltale/service/monitoring/event_log.hpp"

#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace telltale {
namespace {

using ::testing::SizeIs;
using ::testing::StartsWith;

constexpr std::chrono::milliseconds kNoTime{0};

TEST(EventLog, GivesEveryEventOnceInItsOrder) {
  EventLog log;
  const auto start = log.End();
  log.Add("job", "{}");
  log.Add("fleet", "{\"a\":1}");
  const auto batch = log.Await(start, kNoTime);
  ASSERT_THAT(batch.events, SizeIs(2));
  EXPECT_EQ(*batch.events[0], "id: 0\nevent: job\ndata: {}\n\n");
  EXPECT_EQ(*batch.events[1], "id: 1\nevent: fleet\ndata: {\"a\":1}\n\n");
  EXPECT_THAT(log.Await(batch.next, kNoTime).events, SizeIs(0));
}

TEST(EventLog, LetsASlowReaderGoOnAtTheOldestThatIsKept) {
  EventLog log;
  for (int i = 0; i < 1000; ++i) log.Add("job", "{}");
  const auto batch = log.Await(0, kNoTime);
  ASSERT_THAT(batch.events, SizeIs(256));
  EXPECT_THAT(*batch.events.front(), StartsWith("id: 744\n"));
  EXPECT_EQ(batch.next, 1000u);
}

TEST(EventLog, WakesAReaderThatWaits) {
  EventLog log;
  EventLog::Batch batch;
  std::thread reader([&] { batch = log.Await(0, std::chrono::minutes(10)); });
  log.Add("job", "{}");
  reader.join();
  EXPECT_THAT(batch.events, SizeIs(1));
}

TEST(EventLog, EndsEveryWaitWhenItCloses) {
  EventLog log;
  EventLog::Batch batch;
  std::thread reader([&] { batch = log.Await(0, std::chrono::minutes(10)); });
  log.Close();
  reader.join();
  EXPECT_TRUE(batch.closed);
  EXPECT_TRUE(log.Await(0, std::chrono::minutes(10)).closed);
}

}  // namespace
}  // namespace telltale
