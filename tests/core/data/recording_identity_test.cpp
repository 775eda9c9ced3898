#include "telltale/core/data/recording_identity.hpp"

#include <gtest/gtest.h>

namespace telltale {
namespace {

/// A fix a second along a line, from `first` to `last`.
Recording Fixes(int first, int last, double latitude_deg = 63.4) {
  Recording recording;
  for (int i = first; i <= last; ++i) {
    recording.gnss.push_back({1000.0 + i, latitude_deg + 1e-6 * i, 10.3});
  }
  return recording;
}

TEST(RecordingIdentity, SaysWhichRecordingItIs) {
  const RecordingIdentity identity = IdentityOf(Fixes(0, 60), "run1");
  EXPECT_EQ(identity.name, "run1");
  EXPECT_EQ(identity.start_s, 1000.0);
  EXPECT_EQ(identity.end_s, 1060.0);
  EXPECT_EQ(identity.fixes, 61U);
  EXPECT_EQ(identity.marks.size(), 7U);  // at 0, 10, .., 60 s
}

TEST(RecordingIdentity, KnowsTheRecordingAndLongPartsOfItAgain) {
  const RecordingIdentity identity = IdentityOf(Fixes(0, 300), "run1");
  EXPECT_TRUE(SharesFixes(identity, MarksOf(Fixes(0, 300))));
  EXPECT_TRUE(SharesFixes(identity, MarksOf(Fixes(123, 154))));  // 130, 140, 150
  EXPECT_TRUE(SharesFixes(identity, MarksOf(Fixes(-500, 1000))));
  EXPECT_FALSE(SharesFixes(identity, MarksOf(Fixes(125, 144))));  // 130, 140 alone
}

TEST(RecordingIdentity, ToleratesWhatFormatsRound) {
  Recording rounded = Fixes(0, 60);
  for (GnssFix& fix : rounded.gnss) {
    fix.time_s += 1e-5;
    fix.latitude_deg += 1e-9;
  }
  EXPECT_TRUE(SharesFixes(IdentityOf(Fixes(0, 60), "run1"), MarksOf(rounded)));
}

TEST(RecordingIdentity, OverlapsWhicheverHoldsAPartOfTheOther) {
  const auto overlap = [](const Recording& one, const Recording& other) {
    return Overlap(IdentityOf(one, "one"), MarksOf(one), IdentityOf(other, "other"),
                   MarksOf(other));
  };
  EXPECT_TRUE(overlap(Fixes(0, 300), Fixes(123, 154)));
  EXPECT_TRUE(overlap(Fixes(123, 154), Fixes(0, 300)));
  EXPECT_FALSE(overlap(Fixes(0, 300), Fixes(301, 600)));
}

TEST(RecordingIdentity, IsNotThatOfOtherRecordings) {
  const RecordingIdentity identity = IdentityOf(Fixes(0, 300), "run1");
  EXPECT_FALSE(SharesFixes(identity, MarksOf(Fixes(301, 600))));
  EXPECT_FALSE(SharesFixes(identity, MarksOf(Fixes(0, 300, 63.5))));
  EXPECT_FALSE(SharesFixes(identity, {}));
  EXPECT_FALSE(SharesFixes(IdentityOf({}, "empty"), MarksOf(Fixes(0, 300))));
}

// Boats that lie at their mooring when the clock starts share a fix, not a recording.
TEST(RecordingIdentity, OneSharedFixTellsNothing) {
  Recording other = Fixes(0, 300, 63.5);
  other.gnss.front() = Fixes(0, 0).gnss.front();
  EXPECT_FALSE(SharesFixes(IdentityOf(Fixes(0, 300), "run1"), MarksOf(other)));
}

}  // namespace
}  // namespace telltale
