#pragma once

#include <string>

#include "telltale/core/validation/validation.hpp"

namespace telltale {

/// Scores for people: one step beside predicting no change, free run beside holding the velocity
/// and beside the noise floor, per horizon.
std::string MetricsTable(const Metrics& metrics);

}  // namespace telltale
