#pragma once

#include <string_view>
#include <vector>

#include "telltale/core/simulation/manoeuvres.hpp"

namespace telltale {

/// A manoeuvre that advice can name: its name, its instruction with commands as shares of full
/// command, and its commands.
struct CatalogueManoeuvre {
  std::string_view name;
  std::string_view how;
  Manoeuvre manoeuvre;
};

inline constexpr double kCatalogueDurationS = 120.0;

/// Manoeuvres that excite boats, two minutes each: along the course, turning ahead, turning on the
/// spot, without thrust, and at random.
const std::vector<CatalogueManoeuvre>& ManoeuvreCatalogue();

}  // namespace telltale
