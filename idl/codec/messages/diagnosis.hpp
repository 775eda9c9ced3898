#pragma once

#include <cstdint>

#include "telltale/core/diagnosis/diagnosis.hpp"

namespace telltale {

/// A diagnosis of a vehicle's window with the published model that it compares the window with.
struct PublishedDiagnosis {
  Diagnosis diagnosis;
  std::uint64_t model_revision = 0;
  double published_unix_s = 0.0;
};

}  // namespace telltale
