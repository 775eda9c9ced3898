#pragma once

#include <string>

#include "telltale/core/identification/identification.hpp"

namespace telltale {

/// How well the data separate the coefficients, a row per equation, the least identifiable
/// combination of each, and the best two manoeuvres that would determine more. Empty where the
/// model has no excitation summary.
std::string IdentifiabilityTable(const Identification& identification);

}  // namespace telltale
