#include "telltale/service/ingest/senders.hpp"

#include <gtest/gtest.h>

namespace telltale {
namespace {

using Partitions = std::vector<std::string>;

TEST(Senders, MaySendForEveryVehicleUnlessPartitionsAreRequired) {
  Senders senders(false);
  EXPECT_TRUE(senders.MaySend(1, "boat", [](auto) { return Partitions{}; }));
}

TEST(Senders, MaySendForTheVehiclesInWhosePartitionsTheyAre) {
  Senders senders(true);
  const auto partitions_of = [](WriterHandle writer) {
    return writer == 1   ? Partitions{"", "one"}
           : writer == 2 ? Partitions{"two", "three"}
                         : Partitions{};
  };
  EXPECT_TRUE(senders.MaySend(1, "one", partitions_of));
  EXPECT_FALSE(senders.MaySend(1, "two", partitions_of));
  EXPECT_TRUE(senders.MaySend(2, "two", partitions_of));
  EXPECT_TRUE(senders.MaySend(2, "three", partitions_of));
  EXPECT_FALSE(senders.MaySend(3, "one", partitions_of)) << "in no partition";
}

TEST(Senders, AreAskedForTheirPartitionsOnce) {
  Senders senders(true);
  int asked = 0;
  const auto partitions_of = [&asked](auto) {
    ++asked;
    return Partitions{"one"};
  };
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(senders.MaySend(1, "one", partitions_of));
  EXPECT_EQ(asked, 1);
}

}  // namespace
}  // namespace telltale
