#include "telltale/client/cli/fleet_answer.hpp"

#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "telltale/client/cli/table.hpp"
#include "telltale/client/cli/time_span.hpp"

namespace telltale {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(TimeSpan, ReadsUnitsAndRefusesTheRest) {
  EXPECT_EQ(SecondsOf("90"), 90.0);
  EXPECT_EQ(SecondsOf("90s"), 90.0);
  EXPECT_EQ(SecondsOf("1.5min"), 90.0);
  EXPECT_EQ(SecondsOf("12h"), 43200.0);
  EXPECT_EQ(SecondsOf("7d"), 604800.0);
  for (const char* wrong : {"", "d", "7 d", "7w", "-1d", "nan", "inf", "1e300", "7dd"}) {
    EXPECT_FALSE(SecondsOf(wrong)) << wrong;
  }
}

TEST(FleetAnswer, SumsUpARefresh) {
  const std::string text = RefreshSummaryText(
      {{"a", RefreshState::kPublished, 4, PromotionVerdict::kOk, ""},
       {"b", RefreshState::kPublished, 2, PromotionVerdict::kError, "it diverges"},
       {"c", RefreshState::kUnchanged, 0, PromotionVerdict::kUnknown, "no telemetry since"},
       {"d", RefreshState::kRefused, 0, PromotionVerdict::kUnknown, "no gnss samples"}});
  EXPECT_THAT(text,
              AllOf(HasSubstr("published 2 (1 ERROR), unchanged 1, refused 1, failed 0\n"),
                    HasSubstr("b: ERROR, it diverges"), HasSubstr("d: refused, no gnss samples"),
                    Not(HasSubstr("cancelled")), Not(HasSubstr("no telemetry"))));
}

TEST(FleetAnswer, NamesTheSlicesThatNoDaemonAnsweredFor) {
  FleetRequest list;
  list.command = FleetCommand::kList;
  FleetReply reply;
  reply.slices = kAllSlices;
  EXPECT_NO_THROW(RequireWholeFleet(list, reply));
  reply.slices = 0;  // of an older daemon
  EXPECT_NO_THROW(RequireWholeFleet(list, reply));
  reply.slices = ~(SetOf(3) | SetOf(63));
  try {
    RequireWholeFleet(list, reply);
    ADD_FAILURE() << "it is whole";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("2 of 64 slices of the fleet (3, 63)"));
  }
}

TEST(FleetAnswer, AHistorySaysHowManyRevisionsAreNoLongerKept) {
  std::vector<ModelSummary> models(2);
  models[0].revision = 2;
  models[1].revision = 1;
  EXPECT_THAT(ModelHistoryTable(models), Not(HasSubstr("no longer kept")));
  models[0].revision = 9;
  models[1].revision = 4;
  EXPECT_THAT(ModelHistoryTable(models), HasSubstr("7 of 9 revisions are no longer kept."));
}

TEST(FleetAnswer, TablesFitATerminal) {
  const std::string list = VehicleListTable(
      {{"a-boat-of-a-rather-long-name-1",
        1200.0,
        1.0,
        123456,
        86400.0 * 400.0,
        {PromotionVerdict::kWarn, std::string(300, 'x') + " and more words to wrap"}}});
  const std::string history = ModelHistoryTable({{123456,
                                                  1.7e9,
                                                  "FIRST_ORDER_DYNAMIC",
                                                  "OUTPUT_ERROR",
                                                  0.0,
                                                  86400.0,
                                                  1000000,
                                                  {PromotionVerdict::kError, "it diverges"}}});
  EXPECT_THAT(history, AllOf(HasSubstr("2023-11-14 22:13:20"), HasSubstr("ERROR")));
  for (const std::string& text : {list.substr(0, list.find("xxx")), history}) {
    std::size_t start = 0;
    while (start < text.size()) {
      const std::size_t end = std::min(text.find('\n', start), text.size());
      EXPECT_LE(DisplayWidth(text.substr(start, end - start)), kTerminalColumns);
      start = end + 1;
    }
  }
}

}  // namespace
}  // namespace telltale
