#include "telltale/client/cli/table.hpp"
#include "support/special_values.hpp"

#include <limits>
#include <sstream>

#include <gtest/gtest.h>

namespace telltale {
namespace {

TEST(Table, AlignsByCharactersNotBytes) {
  Table table({{"name", Align::kLeft}, {"bound", Align::kRight}, {"unit", Align::kLeft}});
  table.AddRow({"é", "∞", "m"});
  table.AddHeading("YAW");
  table.AddRow({"longer", "-1.5", ""});
  EXPECT_EQ(table.Render(),
            "name    bound  unit\n"
            "───────────────────\n"
            "é           ∞  m\n"
            "YAW\n"
            "longer   -1.5\n");
}

TEST(DisplayWidth, CountsCodePoints) {
  EXPECT_EQ(DisplayWidth(""), 0u);
  EXPECT_EQ(DisplayWidth("abc"), 3u);
  EXPECT_EQ(DisplayWidth("–∞é"), 3u);
}

TEST(Significant, KeepsTheDigitsAskedFor) {
  EXPECT_EQ(Significant(0.5), "0.5000");
  EXPECT_EQ(Significant(-12.3456), "-12.35");
  EXPECT_EQ(Significant(1234.4), "1234");
  EXPECT_EQ(Significant(1.23456e-7), "1.235e-07");
  EXPECT_EQ(Significant(0.0), "0.000");
  EXPECT_EQ(Significant(0.123456, 2), "0.12");
}

TEST(Significant, SaysWhereThereIsNoNumber) {
  EXPECT_EQ(Significant(kInfinity), "∞");
  EXPECT_EQ(Significant(-kInfinity), "-∞");
  EXPECT_EQ(Significant(std::numeric_limits<double>::quiet_NaN()), "–");
  EXPECT_EQ(Fixed(kInfinity, 2), "∞");
  EXPECT_EQ(Plain(-kInfinity), "-∞");
}

TEST(Plain, ShowsWhatAPersonWrote) {
  EXPECT_EQ(Plain(0.2), "0.2");
  EXPECT_EQ(Plain(95.0), "95");
  EXPECT_EQ(Plain(99.9), "99.9");
}

TEST(Wrapped, BreaksBetweenWordsAndIndentsEveryLine) {
  EXPECT_EQ(Wrapped("one two three", "> ", 9), "> one two\n> three\n");
  EXPECT_EQ(Wrapped("  spread   out ", ""), "spread out\n");
  EXPECT_EQ(Wrapped("unbreakable", "", 4), "unbreakable\n");
  EXPECT_EQ(Wrapped(""), "");
}

TEST(Counted, KnowsOneFromMany) {
  EXPECT_EQ(Counted(1, "row", "rows"), "1 row");
  EXPECT_EQ(Counted(0, "row", "rows"), "0 rows");
}

}  // namespace
}  // namespace telltale
