#pragma once

#include <optional>

#include "telltale/core/estimation/regression/excitation.hpp"

namespace telltale {

/// A refusal where rows are too few, or the motion or the command hardly varies.
std::optional<Refusal> RefuseInsufficientExcitation(const EquationProblem& problem,
                                                    const ExcitationLimits& limits);

}  // namespace telltale
