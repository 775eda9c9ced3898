#include "telltale/core/base/solver_log.hpp"

#include <glog/logging.h>
#include <gtest/gtest.h>

namespace telltale {
namespace {

TEST(SolverLog, SilencesWhatTheSolverWrites) {
  SilenceSolverLog();
  testing::internal::CaptureStderr();
  LOG(INFO) << "a line of the solver";
  LOG(WARNING) << "a line of the solver";
  LOG(ERROR) << "a line of the solver";
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace telltale
