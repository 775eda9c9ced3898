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

}  // namespace
}  // namespace telltale
