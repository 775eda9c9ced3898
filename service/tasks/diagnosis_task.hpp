#pragma once

#include <optional>

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/samples.hpp"
#include "telltale/core/diagnosis/diagnose.hpp"
#include "telltale/core/identification/progress.hpp"
#include "telltale/core/vessel/vehicle.hpp"
#include "telltale/idl/codec/daemon_config.hpp"
#include "telltale/idl/codec/messages/exchange.hpp"

namespace telltale {

/// All that a diagnosis is computed from, so that any process may do it.
struct DiagnosisTask {
  DiagnoseRequest request;
  IdentificationSettings settings;  ///< whose workers share the processors
  Vehicle vehicle;
  Identification model;
  Recording since;                    ///< as DiagnosisRecordings has them
  std::optional<Recording> baseline;  ///< likewise
};

/// The options that a request names, and the defaults for the others. The workers share the
/// processors.
DiagnoseOptions OptionsOf(const DiagnoseRequest& request, const IdentificationSettings& settings);

/// Refuses as Prepare() and Diagnose().
Result<DiagnosedModel> Compute(const DiagnosisTask& task, const Progress& progress);

}  // namespace telltale
