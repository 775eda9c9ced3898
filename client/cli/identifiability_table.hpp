#pragma once

#include <string>

#include "telltale/core/identification/identification.hpp"

namespace telltale {

/// How far the data tell coefficients apart, a line for each equation, and the best one or two
/// manoeuvres that would tell more. Empty where a model does not carry it.
std::string IdentifiabilityTable(const Identification& identification);

/// How often the bounds held on simulated repeats. Empty where there is no certificate.
std::string CoverageTable(const Identification& identification);

}  // namespace telltale
