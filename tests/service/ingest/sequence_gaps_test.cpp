#include "telltale/service/ingest/sequence_gaps.hpp"

#include <cstdint>
#include <initializer_list>

#include <gtest/gtest.h>

namespace telltale {
namespace {

/// Ten samples a second.
void NoteFrom(SequenceGaps& gaps, std::uint64_t first, int count, double& time_s) {
  for (int i = 0; i < count; ++i) gaps.Note(first + static_cast<std::uint64_t>(i), time_s += 0.1);
}

SequenceGaps Gaps(std::initializer_list<std::uint64_t> sequence_numbers) {
  SequenceGaps gaps;
  double time_s = 0.0;
  for (const auto number : sequence_numbers) gaps.Note(number, time_s += 0.1);
  return gaps;
}

TEST(SequenceGaps, CountsWhatIsMissingBetweenSamples) {
  EXPECT_EQ(Gaps({1, 2, 3}).lost(), 0u);
  EXPECT_EQ(Gaps({1, 2, 6, 7, 9}).lost(), 4u);
}

TEST(SequenceGaps, BeginsWhereverItJoins) {
  EXPECT_EQ(Gaps({500, 501}).lost(), 0u);
}

TEST(SequenceGaps, CountsASilenceOnceTheBoatSendsOn) {
  SequenceGaps gaps;
  double time_s = 0.0;
  NoteFrom(gaps, 1, 100, time_s);
  time_s += 60.0;
  NoteFrom(gaps, 701, 4, time_s);
  EXPECT_EQ(gaps.lost(), 0u);
  NoteFrom(gaps, 705, 20, time_s);
  EXPECT_EQ(gaps.lost(), 600u);
}

TEST(SequenceGaps, CountsWhatIsMissingAmongTheSamplesThatConfirmASilence) {
  SequenceGaps gaps;
  double time_s = 0.0;
  NoteFrom(gaps, 1, 100, time_s);
  time_s += 60.0;
  for (const std::uint64_t number : {701, 702, 704, 705, 706, 707})
    gaps.Note(number, time_s += 0.1);
  EXPECT_EQ(gaps.lost(), 601u);
}

// 1000 samples a second, of which those of a second are lost.
TEST(SequenceGaps, CountsTheLossOfAChannelThatIsFasterThanUsual) {
  SequenceGaps gaps;
  for (std::uint64_t number = 1; number <= 3000; ++number) {
    if (number <= 1000 || number > 2000) gaps.Note(number, 1e-3 * static_cast<double>(number));
  }
  EXPECT_EQ(gaps.lost(), 1000u);
}

// 2099 samples are missing, in a second in which 2000 could be sent at twice the rate.
TEST(SequenceGaps, CountsNoMoreThanTwiceTheRateOfAChannel) {
  SequenceGaps gaps;
  for (std::uint64_t number = 1; number <= 1000; ++number) {
    gaps.Note(number, 1e-3 * static_cast<double>(number));
  }
  for (std::uint64_t number = 3100; number < 3200; ++number) {  // a second later
    gaps.Note(number, 1e-3 * static_cast<double>(number - 1100));
  }
  EXPECT_EQ(gaps.lost(), 0u);
}

TEST(SequenceGaps, TakesABoatThatStartsAnewForThat) {
  SequenceGaps gaps;
  double time_s = 0.0;
  NoteFrom(gaps, 900'000, 100, time_s);
  NoteFrom(gaps, 1, 100, time_s);
  NoteFrom(gaps, 900'000, 100, time_s);
  EXPECT_EQ(gaps.lost(), 0u);
}

// Among the samples of a boat come forged ones with numbers far ahead.
TEST(SequenceGaps, CountsNothingForForgedNumbers) {
  SequenceGaps gaps;
  double time_s = 0.0;
  std::uint64_t forged = 1;
  for (int i = 0; i < 50; ++i) {
    NoteFrom(gaps, 1 + 10 * static_cast<std::uint64_t>(i), 10, time_s);
    gaps.Note(forged += 900'000, time_s);
  }
  EXPECT_EQ(gaps.lost(), 0u);
}

TEST(SequenceGaps, CountsNoMoreThanABoatCanSend) {
  SequenceGaps gaps;
  double time_s = 0.0;
  NoteFrom(gaps, 1, 100, time_s);
  NoteFrom(gaps, 900'000, 100, time_s);
  EXPECT_EQ(gaps.lost(), 0u);
}

}  // namespace
}  // namespace telltale
