#pragma once

#include <vector>

#include "telltale/core/diagnosis/baseline/nominal_baseline.hpp"
#include "telltale/core/diagnosis/baseline/residual_metric.hpp"
#include "telltale/core/diagnosis/residuals/free_runs.hpp"
#include "telltale/core/diagnosis/residuals/frequency_response.hpp"
#include "telltale/core/diagnosis/residuals/sensitivity.hpp"
#include "telltale/core/diagnosis/residuals/spectral_peak.hpp"

namespace telltale {

/// The random accelerations that the recording shows.
struct ObservedExcitation {
  SpectralPeak peak;
  Eigen::MatrixXd scatter;  ///< what they add to the covariance of a window's errors, rows x rows
  ResponseMoments moments;  ///< of the errors, over the frequencies of a peak that there is
  std::vector<AccelerationSpectra> nominal;  ///< those of the references, that the peak is beside
};

/// What the search for the cause of a recording's errors is given: its free runs at the main
/// horizon, the nominal baseline, the linearisation about it and the metric of its errors. The
/// referenced objects have to outlive it.
struct DiagnosisProblem {
  const FreeRuns& runs;
  const NominalBaseline& nominal;
  const Sensitivity& recording;
  const ResidualMetric& metric;
  const std::vector<EffectParameterRef>& parameter_refs;  ///< columns of by_effect_parameter
  const ObservedExcitation& excitation;
};

}  // namespace telltale
