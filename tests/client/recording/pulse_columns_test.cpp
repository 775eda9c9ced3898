#include "telltale/client/recording/pulse_columns.hpp"

#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace telltale {
namespace {

TEST(PulseColumns, GivesEveryOutputBackAsItWas) {
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  SampleMemory memory;
  PulseColumns columns(memory);
  columns.Add(1.0, std::array{1500.0F, 1500.0F, 0.0F, kNone});
  columns.Add(2.0, std::array{1500.0F, 1600.0F, 0.0F, kNone});
  columns.Add(3.0, std::array{1500.0F, 1600.0F, 0.0F, 1100.0F});
  const auto commands = columns.Of(2, 4);
  ASSERT_EQ(commands.size(), 3u);
  EXPECT_EQ(commands[0].port_us, 1500.0);
  EXPECT_EQ(commands[1].port_us, 1600.0);
  EXPECT_EQ(commands[2].port_us, 1600.0);
  EXPECT_TRUE(std::isnan(commands[0].starboard_us));
  EXPECT_TRUE(std::isnan(commands[1].starboard_us));
  EXPECT_EQ(commands[2].starboard_us, 1100.0);
  EXPECT_EQ(columns.Of(1, 3)[2].port_us, 1500.0);
  EXPECT_EQ(columns.Of(1, 3)[2].starboard_us, 0.0);
  EXPECT_EQ(columns.Of(1, 3)[2].time_s, 3.0);
}

TEST(PulseColumns, GivesNothingOfNothing) {
  SampleMemory memory;
  EXPECT_TRUE(PulseColumns(memory).Of(1, 3).empty());
}

}  // namespace
}  // namespace telltale
