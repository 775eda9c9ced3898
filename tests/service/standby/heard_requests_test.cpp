#include "telltale/service/standby/heard_requests.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace telltale {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

const HeardRequests::Clock::time_point kFirstHeard{100s};

IdentifyRequest Asked(const std::string& id, double deadline_s = 0.0) {
  IdentifyRequest request;
  request.correlation_id = id;
  request.vehicle_id = "boat";
  request.deadline_s = deadline_s;
  return request;
}

std::vector<std::string> IdsOf(const std::vector<HeardRequest>& requests) {
  std::vector<std::string> ids;
  for (const HeardRequest& heard : requests) ids.push_back(CorrelationIdOf(heard.request));
  return ids;
}

TEST(HeardRequests, AreTakenInTheirOrderWithoutThoseThatAreAnswered) {
  HeardRequests heard;
  EXPECT_TRUE(heard.Note(Asked("b"), kFirstHeard));
  EXPECT_TRUE(heard.Note(Asked("a"), kFirstHeard));
  EXPECT_TRUE(heard.Note(Asked("c"), kFirstHeard));
  EXPECT_TRUE(heard.Note(Asked("b"), kFirstHeard + 1s)) << "a client asks again";
  heard.Answered("a");
  EXPECT_THAT(IdsOf(heard.TakeUnanswered(kFirstHeard + 1s)), ElementsAre("b", "c"));
}

// A client that asks while the answer is under way.
TEST(HeardRequests, DoNotHoldWhatWasAnsweredBefore) {
  HeardRequests heard;
  heard.Answered("a");
  EXPECT_TRUE(heard.Note(Asked("a"), kFirstHeard));
  EXPECT_THAT(heard.TakeUnanswered(kFirstHeard), IsEmpty());
}

TEST(HeardRequests, KeepWhatIsLeftOfTheirDeadlines) {
  HeardRequests heard;
  heard.Note(Asked("passed", 2.0), kFirstHeard);
  heard.Note(Asked("in-time", 10.0), kFirstHeard);
  heard.Note(Asked("without"), kFirstHeard);
  const auto left = heard.TakeUnanswered(kFirstHeard + 4s);
  ASSERT_THAT(IdsOf(left), ElementsAre("in-time", "without"));
  EXPECT_DOUBLE_EQ(std::get<IdentifyRequest>(left[0].request).deadline_s, 6.0);
  EXPECT_EQ(std::get<IdentifyRequest>(left[1].request).deadline_s, 0.0);
}

TEST(HeardRequests, TellWhichOfThemWereBegun) {
  HeardRequests heard;
  heard.Begun("stranger");
  for (const char* id : {"begun", "waits"}) heard.Note(Asked(id), kFirstHeard);
  heard.Begun("begun");
  heard.Note(Asked("begun"), kFirstHeard + 1s);  // a client asks again
  const auto requests = heard.TakeUnanswered(kFirstHeard + 1s);
  ASSERT_THAT(IdsOf(requests), ElementsAre("begun", "waits"));
  EXPECT_TRUE(requests[0].begun);
  EXPECT_FALSE(requests[1].begun);
}

TEST(HeardRequests, AreNotNotedOnceTheyAreTaken) {
  HeardRequests heard;
  heard.TakeUnanswered(kFirstHeard);
  EXPECT_FALSE(heard.Note(Asked("a"), kFirstHeard));
}

TEST(HeardRequests, AreBounded) {
  HeardRequests heard;
  const std::size_t asked = 3 * HeardRequests::kMost;
  for (std::size_t i = 0; i < asked; ++i) heard.Note(Asked(std::to_string(i)), kFirstHeard);
  const auto ids = IdsOf(heard.TakeUnanswered(kFirstHeard));
  ASSERT_EQ(ids.size(), HeardRequests::kMost);
  EXPECT_EQ(ids.back(), std::to_string(asked - 1));
}

}  // namespace
}  // namespace telltale
