#include "telltale/service/models/free_run_error.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace telltale {
namespace {

TEST(PredictionError, IsOneWhereNothingChangedAndScalesWithTheError) {
  const FreeRunError reference{0.1, 0.2, 0.3};
  EXPECT_DOUBLE_EQ(RelativeError(reference, reference), 1.0);
  EXPECT_DOUBLE_EQ(RelativeError({0.3, 0.6, 0.9}, reference), 3.0);
  EXPECT_DOUBLE_EQ(RelativeError({0.2, 0.2, 0.3}, reference), std::sqrt(2.0));
}

}  // namespace
}  // namespace telltale
