#include "telltale/client/cli/quality_rounds.hpp"

#include <string_view>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace telltale {
namespace {

using ::testing::Contains;
using ::testing::Key;

constexpr WriterHandle kOne = 11;
constexpr WriterHandle kTwo = 22;

Quality About(std::string_view vehicle_id) {
  Quality quality;
  quality.vehicle_id = vehicle_id;
  return quality;
}

TEST(QualityRounds, OfOneDaemonAreCompleteFromTheSecondEndOn) {
  QualityRounds rounds;
  rounds.Take(About("b"), kOne);  // it was joined half-way: "a" was before
  rounds.Take(About(kUnattributed), kOne);
  EXPECT_EQ(rounds.complete(), 0u);
  rounds.Take(About("a"), kOne);
  rounds.Take(About("b"), kOne);
  rounds.Take(About(kUnattributed), kOne);
  EXPECT_EQ(rounds.complete(), 1u);
  rounds.Take(About(kUnattributed), kOne);
  EXPECT_EQ(rounds.complete(), 2u);
}

TEST(QualityRounds, OfDaemonsThatShareAFleetHaveTheBoatsOfAll) {
  QualityRounds rounds;
  rounds.Take(About(kUnattributed), kOne);  // "a" was before
  rounds.Take(About("b"), kTwo);
  rounds.Take(About(kUnattributed), kTwo);
  EXPECT_EQ(rounds.complete(), 0u);
  rounds.Take(About("a"), kOne);
  rounds.Take(About(kUnattributed), kOne);
  EXPECT_EQ(rounds.complete(), 1u);
  EXPECT_THAT(rounds.fleet(), Contains(Key("a")));
  EXPECT_THAT(rounds.fleet(), Contains(Key("b")));
  rounds.Take(About("b"), kTwo);
  rounds.Take(About(kUnattributed), kTwo);
  EXPECT_EQ(rounds.complete(), 1u) << "a table a round, however many daemons there are";
}

TEST(QualityRounds, GoOnWithTheDaemonThatIsLeft) {
  QualityRounds rounds;
  for (const WriterHandle daemon : {kOne, kTwo, kOne}) rounds.Take(About(kUnattributed), daemon);
  ASSERT_EQ(rounds.complete(), 1u);
  rounds.Take(About(kUnattributed), kTwo);
  rounds.Take(About(kUnattributed), kTwo);
  EXPECT_EQ(rounds.complete(), 2u);
}

}  // namespace
}  // namespace telltale
