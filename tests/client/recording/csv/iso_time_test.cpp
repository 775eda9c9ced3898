#include "telltale/client/recording/csv/iso_time.hpp"

#include <gtest/gtest.h>

namespace telltale {
namespace {

// `date -u -d TEXT +%s` of GNU coreutils gives these seconds.
TEST(IsoTime, CountsSecondsSince1970) {
  EXPECT_EQ(SecondsOfIsoTime("1970-01-01T00:00:00Z"), 0.0);
  EXPECT_EQ(SecondsOfIsoTime("2023-11-14 22:13:20.5"), 1700000000.5);
  EXPECT_EQ(SecondsOfIsoTime("2023-11-14T23:13:20+01:00"), 1700000000.0);
  EXPECT_EQ(SecondsOfIsoTime("2023-11-14T16:43:20-0530"), 1700000000.0);
  EXPECT_EQ(SecondsOfIsoTime("2024-02-29 00:00:00+00"), 1709164800.0);
}

TEST(IsoTime, IsNothingOfAnyOtherText) {
  for (const char* text :
       {"", "12.5", "2023-11-14", "2023-11-14 22:13", "2023-13-14 22:13:20", "2023-02-29 00:00:00",
        "2023-11-14 22:61:20", "2023-11-14 22:13:99", "2023-11-14 22:13:20 h",
        "14.11.2023 22:13:20", "2023-11-14 22:13:20+"}) {
    EXPECT_FALSE(SecondsOfIsoTime(text)) << text;
  }
}

}  // namespace
}  // namespace telltale
