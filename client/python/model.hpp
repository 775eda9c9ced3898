#pragma once

#include <optional>

#include "telltale/core/identification/identification.hpp"
#include "telltale/core/validation/validation.hpp"

namespace telltale::python {

/// A model, and its scores on data that took no part in fitting, where it has just been identified.
struct ScoredIdentification {
  Identification model;
  std::optional<Metrics> held_out = std::nullopt;
};

}  // namespace telltale::python
