#include "telltale/service/monitoring/quality_verdict.hpp"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace telltale {
namespace {

using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A boat with a model, a thousand good samples in the last minute.
Quality GoodQuality() {
  Quality quality;
  quality.vehicle_id = "boat-1";
  quality.model_revision = 4;
  quality.prediction_error = 1.1;
  return quality;
}

LastMinute GoodMinute() {
  LastMinute last;
  last.ever_arrived = true;
  last.silent_s = {0.2, 0.1, 0.1};
  last.arrived = 1000;
  return last;
}

std::vector<std::string> Codes(const std::vector<QualityReason>& reasons) {
  std::vector<std::string> codes;
  for (const QualityReason& reason : reasons) codes.push_back(reason.code);
  return codes;
}

TEST(QualityVerdict, IsErrorWhereTheModelIsKnownToBeWrong) {
  Quality quality = GoodQuality();
  quality.model_verdict = {PromotionVerdict::kError, "it diverges"};
  const auto reasons = ReasonsOf(quality, GoodMinute());
  EXPECT_THAT(Codes(reasons), ElementsAre("MODEL_ERROR"));
  EXPECT_EQ(VerdictOf(reasons), QualityVerdict::kError);
  EXPECT_EQ(reasons.front().text, "revision 4 is not to be relied on: it diverges");
  quality.model_verdict.verdict = PromotionVerdict::kWarn;
  EXPECT_THAT(ReasonsOf(quality, GoodMinute()), IsEmpty());
}

TEST(QualityVerdict, IsOkWhereNothingIsWrong) {
  const auto reasons = ReasonsOf(GoodQuality(), GoodMinute());
  EXPECT_THAT(reasons, IsEmpty());
  EXPECT_EQ(VerdictOf(reasons), QualityVerdict::kOk);
}

TEST(QualityVerdict, IsStaleWithoutTelemetry) {
  LastMinute last = GoodMinute();
  last.silent_s = {42.0, 41.0, 43.0};
  const auto reasons = ReasonsOf(GoodQuality(), last);
  EXPECT_THAT(Codes(reasons), ElementsAre("NO_TELEMETRY"));
  EXPECT_THAT(reasons[0].text, HasSubstr("41 s"));
  EXPECT_EQ(VerdictOf(reasons), QualityVerdict::kStale);
  EXPECT_EQ(VerdictOf(ReasonsOf(GoodQuality(), LastMinute())), QualityVerdict::kStale);
}

TEST(QualityVerdict, NamesTheChannelThatIsSilent) {
  LastMinute last = GoodMinute();
  last.silent_s[1] = 12.0;
  const auto reasons = ReasonsOf(GoodQuality(), last);
  ASSERT_THAT(Codes(reasons), ElementsAre("CHANNEL_SILENT"));
  EXPECT_EQ(reasons[0].text, "no heading samples for 12 s");
  EXPECT_EQ(VerdictOf(reasons), QualityVerdict::kError);
}

/// Each count alone, just below its limit and just above.
TEST(QualityVerdict, KeepsToItsLimits) {
  struct Case {
    std::uint64_t rejected, lost;
    RejectReason reason;
    QualityVerdict verdict;
  };
  using enum QualityVerdict;
  for (const Case& c :
       {Case{50, 0, RejectReason::kDuplicate, kOk}, Case{51, 0, RejectReason::kDuplicate, kWarn},
        Case{500, 0, RejectReason::kDuplicate, kWarn},
        Case{501, 0, RejectReason::kDuplicate, kError}, Case{4, 0, RejectReason::kClockJump, kOk},
        Case{5, 0, RejectReason::kClockJump, kWarn}, Case{4, 0, RejectReason::kStuckSensor, kOk},
        Case{5, 0, RejectReason::kStuckSensor, kWarn}, Case{0, 52, RejectReason::kDuplicate, kOk},
        Case{0, 53, RejectReason::kDuplicate, kWarn}}) {
    LastMinute last = GoodMinute();
    last.lost = c.lost;
    last.rejected.Count(Channel::kHeading, c.reason, c.rejected);
    EXPECT_EQ(VerdictOf(ReasonsOf(GoodQuality(), last)), c.verdict)
        << c.rejected << ' ' << Name(c.reason) << ", " << c.lost << " lost";
  }
}

TEST(QualityVerdict, WarnsWhereMoreThanOneInTwentyIsShed) {
  LastMinute last = GoodMinute();
  last.shed = last.arrived / 20;
  EXPECT_EQ(VerdictOf(ReasonsOf(GoodQuality(), last)), QualityVerdict::kOk);
  ++last.shed;
  EXPECT_THAT(Codes(ReasonsOf(GoodQuality(), last)), ElementsAre("SHED"));
}

TEST(QualityVerdict, OneJumpOfTheClockWarns) {
  LastMinute last = GoodMinute();
  last.clock_jumps = 1;
  const auto reasons = ReasonsOf(GoodQuality(), last);
  ASSERT_THAT(Codes(reasons), ElementsAre("CLOCK_JUMP"));
  EXPECT_EQ(reasons[0].text, "the boat's clock jumped once in the last minute");
  EXPECT_EQ(VerdictOf(reasons), QualityVerdict::kWarn);
  last.clock_jumps = 2;
  last.rejected.Count(Channel::kHeading, RejectReason::kClockJump, 8);
  EXPECT_THAT(Codes(ReasonsOf(GoodQuality(), last)), ElementsAre("CLOCK_JUMP"));
}

TEST(QualityVerdict, DriftIsAnErrorOnceTheModelIsFarOff) {
  Quality quality = GoodQuality();
  quality.prediction_error = 2.9;
  quality.drift_since_unix_s = 1000.0;
  quality.drift_evidence = "the errors show: drag 40 % more; or current";
  EXPECT_EQ(VerdictOf(ReasonsOf(quality, GoodMinute())), QualityVerdict::kWarn);
  quality.prediction_error = 3.0;
  const auto reasons = ReasonsOf(quality, GoodMinute());
  EXPECT_EQ(VerdictOf(reasons), QualityVerdict::kError);
  EXPECT_THAT(reasons[0].text, EndsWith("boat: the errors show: drag 40 % more; or current"));
}

TEST(QualityVerdict, WarnsWithoutAModelAndOfARefusal) {
  Quality quality = GoodQuality();
  quality.model_revision.reset();
  EXPECT_THAT(Codes(ReasonsOf(quality, GoodMinute())), ElementsAre("NO_MODEL"));
  quality.last_refusal = Refusal{"window", "holds 3 s", "wait"};
  const auto reasons = ReasonsOf(quality, GoodMinute());
  EXPECT_THAT(Codes(reasons), ElementsAre("REFUSED"));
  EXPECT_THAT(reasons[0].text, HasSubstr("window: holds 3 s"));
}

TEST(QualityVerdict, PutsTheMostSeriousFirst) {
  Quality quality = GoodQuality();
  quality.drift_since_unix_s = 1000.0;  // WARN
  LastMinute last = GoodMinute();
  last.lost = 900;           // WARN
  last.silent_s[0] = 100.0;  // ERROR
  EXPECT_THAT(Codes(ReasonsOf(quality, last)), ElementsAre("CHANNEL_SILENT", "LOST", "DRIFT"));
  last.silent_s = {20.0, 20.0, 20.0};
  EXPECT_EQ(VerdictOf(ReasonsOf(quality, last)), QualityVerdict::kStale);
}

TEST(RecentTelemetry, CountsTheLastMinuteAlone) {
  using std::chrono::seconds;
  RecentTelemetry recent;
  WindowState state;
  const RecentTelemetry::Clock::time_point start{seconds(1000)};
  for (int s = 0; s <= 200; ++s) {
    state.arrived = {static_cast<std::uint64_t>(10 * s), static_cast<std::uint64_t>(5 * s),
                     static_cast<std::uint64_t>(s < 150 ? s : 150)};
    if (s == 100) state.lost += 1000;  // long ago in the end
    if (s == 190) state.lost += 7;
    if (s == 20 || s == 170) ++state.clock_jumps;
    recent.Note(state, start + seconds(s));
  }
  const LastMinute last = recent.Summary();
  EXPECT_TRUE(last.ever_arrived);
  EXPECT_EQ(last.lost, 7u);
  EXPECT_EQ(last.clock_jumps, 1u);
  EXPECT_EQ(last.arrived, 60u * 15u + 10u);
  EXPECT_THAT(last.silent_s, ElementsAre(0.0, 0.0, 50.0));
}

TEST(QualityVerdict, WarnsWhereNothingIsSaved) {
  const auto reasons = ReasonsOf(GoodQuality(), GoodMinute(), "models.sqlite: disk full");
  EXPECT_THAT(Codes(reasons), ElementsAre("NOT_SAVED"));
  EXPECT_EQ(VerdictOf(reasons), QualityVerdict::kWarn);
  EXPECT_THAT(reasons.front().text, HasSubstr("disk full"));
}

}  // namespace
}  // namespace telltale
