#include "telltale/core/base/gauss_markov_series.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace telltale {
namespace {

// The series is that of exp(-t / T), which a Gauss-Markov process has for a correlation. Its terms
// fall as 1 / k^2, so that those beyond 400 sum up to 2 / (pi^2 400 T/H) at most.
TEST(GaussMarkovShare, SumsUpToTheCorrelation) {
  constexpr int kTerms = 400;
  for (const double lasting : {0.2, 1.0, 5.0}) {
    for (const double t : {0.0, 0.1, 0.5, 0.9, 1.0}) {
      double sum = 0.0;
      for (int k = 0; k <= kTerms; ++k)
        sum += GaussMarkovShare(k, lasting) * std::cos(k * M_PI * t);
      EXPECT_NEAR(sum, std::exp(-t / lasting), 2.0 / (M_PI * M_PI * kTerms * lasting))
          << lasting << ", " << t;
    }
  }
}

TEST(GaussMarkovShare, IsAShareOfVariance) {
  for (int k = 0; k < 20; ++k) {
    EXPECT_GT(GaussMarkovShare(k, 0.5), 0.0);
    EXPECT_LT(GaussMarkovShare(k, 0.5), 1.0);
  }
}

}  // namespace
}  // namespace telltale
