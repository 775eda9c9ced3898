#include "telltale/core/base/parallel.hpp"

#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace telltale {
namespace {

using ::testing::Each;

TEST(ForEachIndex, CallsEveryIndexOnceWhateverTheThreads) {
  for (const std::size_t threads : {std::size_t{1}, std::size_t{2}, std::size_t{256}}) {
    std::vector<int> calls(10'000, 0);
    ForEachIndex(calls.size(), threads, [&](std::size_t i) { ++calls[i]; });
    EXPECT_THAT(calls, Each(1)) << threads << " threads";
  }
}

TEST(ForEachIndex, MakesWritesVisibleToTheCaller) {
  std::vector<double> squares(1'000);
  ForEachIndex(squares.size(), 4, [&](std::size_t i) { squares[i] = static_cast<double>(i * i); });
  for (std::size_t i = 0; i < squares.size(); ++i) {
    EXPECT_EQ(squares[i], static_cast<double>(i * i));
  }
}

TEST(ForEachIndex, DoesNothingForNone) {
  ForEachIndex(0, 4, [](std::size_t) { FAIL() << "called for an index that is not there"; });
}

TEST(ForEachIndex, PassesAnExceptionToTheCaller) {
  for (const std::size_t threads : {std::size_t{1}, std::size_t{4}}) {
    EXPECT_THROW(ForEachIndex(1'000, threads,
                              [](std::size_t i) {
                                if (i == 700) throw std::runtime_error("the seven hundredth");
                              }),
                 std::runtime_error);
  }
}

}  // namespace
}  // namespace telltale
