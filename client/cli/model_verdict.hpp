#pragma once

#include <optional>
#include <string>

#include "telltale/core/identification/identification.hpp"
#include "telltale/core/validation/held_out_score.hpp"

namespace telltale {

/// What a model is good for, in sentences: how well it predicts data that took no part in fitting,
/// whether it can be simulated, and what to record next. Without a score it says how to get one.
std::string ModelVerdict(const Identification& identification,
                         const std::optional<HeldOutScore>& score);

}  // namespace telltale
