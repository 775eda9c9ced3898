#include "telltale/service/monitoring/drift_detector.hpp"

#include <algorithm>
#include <cmath>

namespace telltale {
namespace {

// Weather whose strength doubles from day to day does not reach it: docs/validation/monitoring.md.
constexpr double kToleratedRelativeError = 4.0;
constexpr double kAlarmThreshold = 20.0;
constexpr double kExcessLimit = 2.0 * kAlarmThreshold;  // so that an alarm ends after its cause

}  // namespace

void DriftDetector::Add(double relative_error) {
  if (std::isnan(relative_error)) return;
  excess_ = std::clamp(excess_ + relative_error - kToleratedRelativeError, 0.0, kExcessLimit);
  if (excess_ >= kAlarmThreshold) fires_ = true;
  if (excess_ == 0.0) fires_ = false;
}

}  // namespace telltale
