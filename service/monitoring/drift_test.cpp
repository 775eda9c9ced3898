#include "telltale/service/monitoring/drift_test.hpp"

#include <algorithm>
#include <cmath>

namespace telltale {
namespace {

// Calibrated by DriftCalibration: what weather that changes by a third gains and loses again.
constexpr double kTolerated = 1.75;
constexpr double kEnough = 20.0;
constexpr double kMost = 2.0 * kEnough;  // so that it ends some time after the cause does

}  // namespace

void DriftTest::Add(double relative_error) {
  if (std::isnan(relative_error)) return;
  excess_ = std::clamp(excess_ + relative_error - kTolerated, 0.0, kMost);
  if (excess_ >= kEnough) fires_ = true;
  if (excess_ == 0.0) fires_ = false;
}

}  // namespace telltale
