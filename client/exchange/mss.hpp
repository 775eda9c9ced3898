#pragma once

#include <string>

#include "telltale/core/identification/identification.hpp"
#include "telltale/core/vessel/vehicle.hpp"

namespace telltale {

/// The model for Fossen's MSS and Python Vehicle Simulator: JSON of M^-1-normalised coefficients,
/// each with what it is in physical parameters, and the parameters that position, heading and pulse
/// widths cannot tell. docs/guides/model-exchange.md.
std::string PrintMss(const Identification& identification, const Vehicle& vehicle);

}  // namespace telltale
