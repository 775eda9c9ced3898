#include "telltale/service/registry/reader_lifetime.hpp"

#include <chrono>

#include <gtest/gtest.h>

namespace telltale {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kMost = 3;
constexpr ReaderLifetime::Time kBegun{1000h};

TEST(ReaderLifetime, HasNoEndWhileIdsStayWithinTheirLimit) {
  ReaderLifetime lifetime(kMost, kBegun);
  for (std::size_t i = 0; i < kMost; ++i) lifetime.NoteUnknownRetired();
  EXPECT_FALSE(lifetime.IsOver(kBegun + 24h));
}

TEST(ReaderLifetime, EndsTenMinutesAfterItsBeginningOnceItIsFull) {
  ReaderLifetime lifetime(kMost, kBegun);
  lifetime.NoteFull();
  EXPECT_FALSE(lifetime.IsOver(kBegun + 10min - 1s));
  EXPECT_TRUE(lifetime.IsOver(kBegun + 10min));
}

// To hear all anew takes a second: whoever retires ids that nobody knows must not ask for it all
// the time.
TEST(ReaderLifetime, IsAMinuteAtLeastHoweverManyUnknownIdsAreRetired) {
  ReaderLifetime lifetime(kMost, kBegun);
  for (std::size_t i = 0; i <= 1000 * kMost; ++i) lifetime.NoteUnknownRetired();
  EXPECT_FALSE(lifetime.IsOver(kBegun + 1min - 1s));
  EXPECT_TRUE(lifetime.IsOver(kBegun + 1min));
}

}  // namespace
}  // namespace telltale
