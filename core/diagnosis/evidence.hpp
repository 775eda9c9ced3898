#pragma once

#include <vector>

#include "telltale/core/diagnosis/free_runs.hpp"
#include "telltale/core/diagnosis/healthy.hpp"
#include "telltale/core/diagnosis/judge.hpp"
#include "telltale/core/diagnosis/sensitivity.hpp"
#include "telltale/core/diagnosis/swings.hpp"

namespace telltale {

/// A recording as the search for its cause sees it.
struct Evidence {
  const FreeRuns& runs;
  const Healthy& healthy;
  const Sensitivity& recording;
  const Judge& judge;
  const std::vector<Slot>& slots;
  const Swings& swings;
};

}  // namespace telltale
