#pragma once

#include <vector>

#include "telltale/core/diagnosis/baseline/nominal_baseline.hpp"
#include "telltale/core/diagnosis/baseline/residual_metric.hpp"
#include "telltale/core/diagnosis/residuals/free_runs.hpp"
#include "telltale/core/diagnosis/residuals/frequency_response.hpp"
#include "telltale/core/diagnosis/residuals/sensitivity.hpp"

namespace telltale {

/// A recording as the search for its cause sees it.
struct DiagnosisProblem {
  const FreeRuns& runs;
  const NominalBaseline& nominal;
  const Sensitivity& recording;
  const ResidualMetric& metric;
  const std::vector<EffectParameterRef>& parameter_refs;
  const FrequencyResponse& frequency_response;
};

}  // namespace telltale
