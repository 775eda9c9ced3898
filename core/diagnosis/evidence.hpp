#pragma once

#include <vector>

#include "diagnosis/free_runs.hpp"
#include "diagnosis/healthy.hpp"
#include "diagnosis/judge.hpp"
#include "diagnosis/sensitivity.hpp"
#include "diagnosis/swings.hpp"

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
