#include "telltale/core/uncertainty/coverage.hpp"

#include <gtest/gtest.h>

namespace telltale {
namespace {

struct BinomialTruth {
  Tally tally;
  double level;
  double lower;
  double upper;
};

/// Bisected in Python: the p at which sum_{i >= k} comb(n, i) p^i (1 - p)^(n - i) is half of what
/// the level leaves, and likewise from the other side.
TEST(BinomialInterval, IsThatOfClopperAndPearson) {
  for (const BinomialTruth& truth : {BinomialTruth{{0, 10}, 0.95, 0.0000000000, 0.3084971078},
                                     BinomialTruth{{5, 10}, 0.95, 0.1870860284, 0.8129139716},
                                     BinomialTruth{{10, 10}, 0.95, 0.6915028922, 1.0000000000},
                                     BinomialTruth{{95, 100}, 0.95, 0.8871650889, 0.9835681208},
                                     BinomialTruth{{57, 60}, 0.95, 0.8607567533, 0.9895676704},
                                     BinomialTruth{{9, 20}, 0.9, 0.2586506097, 0.6530686024}}) {
    const Interval interval = BinomialInterval(truth.tally, truth.level);
    EXPECT_EQ(interval.level, truth.level);
    EXPECT_NEAR(interval.lower, truth.lower, 1e-9) << truth.tally.held;
    EXPECT_NEAR(interval.upper, truth.upper, 1e-9) << truth.tally.held;
  }
}

TEST(BinomialInterval, SaysNothingOfNothing) {
  const Interval interval = BinomialInterval({}, 0.95);
  EXPECT_EQ(interval.lower, 0.0);
  EXPECT_EQ(interval.upper, 1.0);
  EXPECT_EQ(Tally{}.Share(), 0.0);
}

}  // namespace
}  // namespace telltale
