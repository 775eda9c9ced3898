#pragma once

#include <string>

#include "telltale/core/validation/validation.hpp"

namespace telltale {

/// Whether a free run left what any of these vessels can do, so that its error has no meaning.
bool Diverges(const FreeRunScores& scores);

/// Scores for people: one step beside constant velocity, free runs beside constant velocity and the
/// noise floor, per horizon.
std::string MetricsTable(const Metrics& metrics);

}  // namespace telltale
