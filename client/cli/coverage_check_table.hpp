#pragma once

#include <string>

#include "telltale/core/identification/identification.hpp"

namespace telltale {

/// How often the bounds held on simulated replicates of the data. Empty without a coverage check.
std::string CoverageTable(const Identification& identification);

}  // namespace telltale
