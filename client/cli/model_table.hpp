#pragma once

#include <optional>
#include <string>

#include "telltale/core/identification/identification.hpp"
#include "telltale/core/validation/held_out_score.hpp"

namespace telltale {

/// A model for people, within 80 columns: the verdict, the values that a simulation uses with their
/// bounds, refusals, then the estimates, how identifiable they are and what they rest on.
std::string ModelTable(const Identification& identification,
                       const std::optional<HeldOutScore>& score = std::nullopt);

}  // namespace telltale
