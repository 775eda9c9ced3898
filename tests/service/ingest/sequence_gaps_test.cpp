#include "telltale/service/ingest/sequence_gaps.hpp"

#include <cstdint>
#include <initializer_list>

#include <gtest/gtest.h>

namespace telltale {
namespace {

SequenceGaps Gaps(std::initializer_list<std::uint64_t> sequence_numbers) {
  SequenceGaps gaps;
  for (const auto number : sequence_numbers) gaps.Note(number);
  return gaps;
}

TEST(SequenceGaps, CountsWhatIsMissingBetweenSamples) {
  EXPECT_EQ(Gaps({1, 2, 3}).lost(), 0u);
  EXPECT_EQ(Gaps({1, 2, 6, 7, 9}).lost(), 4u);
}

TEST(SequenceGaps, BeginsWhereverItJoins) {
  EXPECT_EQ(Gaps({500, 501}).lost(), 0u);
}

TEST(SequenceGaps, TakesABoatThatStartsAnewForThat) {
  EXPECT_EQ(Gaps({7, 8, 1, 2, 4}).lost(), 1u);
  EXPECT_EQ(Gaps({1, 2, std::uint64_t{1} << 60}).lost(), 0u);
}

}  // namespace
}  // namespace telltale
