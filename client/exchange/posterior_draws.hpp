#pragma once

#include <cstdint>
#include <string>

#include "telltale/core/identification/posterior_draws.hpp"

namespace telltale {

/// "SURGE u|u|" and the like: what a column of coefficients is called. A parameter of no equation
/// is called by its symbol.
std::string ColumnName(const Coefficient& coefficient);

/// Draws for domain randomisation as JSON, with what was not drawn and why it may be trusted.
std::string PrintDrawsJson(const Identification& identification, const PosteriorDraws& draws,
                           std::uint64_t seed);

/// The same numbers as comma-separated values, one draw a row, under a header of "SURGE u|u|" and
/// the like; numbers read back to the same bits.
std::string PrintDrawsCsv(const Identification& identification, const PosteriorDraws& draws);

}  // namespace telltale
