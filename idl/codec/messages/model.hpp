#pragma once

#include <cstdint>

#include "telltale/core/identification/identification.hpp"
#include "telltale/core/validation/promotion.hpp"

namespace telltale {

/// An identification with its place in the vehicle's history.
struct PublishedModel {
  Identification identification;
  std::uint64_t revision = 0;  ///< counts up by one per vehicle, from 1; 0: not published
  double published_unix_s = 0.0;
  Promotion promotion = {};  ///< unknown from writers that know of none
};

}  // namespace telltale
