#include "telltale/service/jobs/exchange_history.hpp"

#include <string>

#include <gtest/gtest.h>

#include "telltale/idl/codec/messages/exchange.hpp"

namespace telltale {
namespace {

using History = ExchangeHistory<IdentifyProgress, IdentifyReply>;

IdentifyProgress Queued(const std::string& correlation_id) {
  return {{correlation_id, "boat", "queued", 0.0}};
}

IdentifyReply Refused(const std::string& correlation_id) {
  IdentifyReply reply;
  reply.correlation_id = correlation_id;
  reply.outcome = ReplyOutcome::kRefused;
  return reply;
}

TEST(ExchangeHistory, AnswersWithProgressUntilTheReplyIsThere) {
  History history;
  EXPECT_FALSE(history.Find("a"));
  history.Begin(Queued("a"));
  ASSERT_TRUE(history.Find("a"));
  EXPECT_EQ(std::get<IdentifyProgress>(*history.Find("a")).stage, "queued");
  history.Finish(Refused("a"));
  EXPECT_EQ(std::get<IdentifyReply>(*history.Find("a")).outcome, ReplyOutcome::kRefused);
  EXPECT_FALSE(history.Find("b"));
}

TEST(ExchangeHistory, ReportsANewStageAndAFiftiethOfTheWork) {
  History history;
  history.Begin(Queued("a"));
  EXPECT_TRUE(history.Advance("a", "bootstrap", 0.5));
  EXPECT_FALSE(history.Advance("a", "bootstrap", 0.51));
  EXPECT_TRUE(history.Advance("a", "bootstrap", 0.53));
  const auto beyond = history.Advance("a", "publish", 1.5);
  ASSERT_TRUE(beyond);
  EXPECT_EQ(beyond->fraction, 1.0);
  EXPECT_EQ(std::get<IdentifyProgress>(*history.Find("a")).stage, "publish");
}

TEST(ExchangeHistory, KeepsTheLatestReplies) {
  History history;
  for (std::size_t i = 0; i <= History::kKeptReplies; ++i) {
    history.Begin(Queued(std::to_string(i)));
    history.Finish(Refused(std::to_string(i)));
  }
  EXPECT_FALSE(history.Find("0"));
  EXPECT_TRUE(history.Find("1"));
  EXPECT_TRUE(history.Find(std::to_string(History::kKeptReplies)));
}

// A model with many coefficients or a diagnosis with pictures may take megabytes.
TEST(ExchangeHistory, KeepsSoManyBytesOfRepliesAndTheNewestInAnyCase) {
  const auto long_reply = [](const std::string& correlation_id, std::size_t bytes) {
    IdentifyReply reply = Refused(correlation_id);
    reply.message = std::string(bytes, 'x');
    return reply;
  };
  constexpr std::size_t kMoreThanAThird = History::kKeptBytes / 3 + 1;
  History history;
  for (const char* id : {"a", "b", "c"}) history.Finish(long_reply(id, kMoreThanAThird));
  EXPECT_FALSE(history.Find("a"));
  EXPECT_TRUE(history.Find("b"));
  EXPECT_TRUE(history.Find("c"));
  history.Finish(long_reply("huge", 2 * History::kKeptBytes));
  EXPECT_FALSE(history.Find("c"));
  EXPECT_TRUE(history.Find("huge"));
  history.Finish(Refused("d"));
  EXPECT_FALSE(history.Find("huge"));
  EXPECT_TRUE(history.Find("d"));
}

TEST(ExchangeHistory, KeepsTheLastReplyToAnIdOnce) {
  History history;
  history.Finish(Refused("a"));
  IdentifyReply second = Refused("a");
  second.message = "second";
  history.Finish(second);
  for (std::size_t i = 1; i < History::kKeptReplies; ++i)
    history.Finish(Refused(std::to_string(i)));
  ASSERT_TRUE(history.Find("a"));
  EXPECT_EQ(std::get<IdentifyReply>(*history.Find("a")).message, "second");
}

}  // namespace
}  // namespace telltale
