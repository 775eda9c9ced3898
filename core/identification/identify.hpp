#pragma once

#include <string>

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/preparation.hpp"
#include "telltale/core/data/samples.hpp"
#include "telltale/core/estimation/regression/excitation.hpp"
#include "telltale/core/estimation/regression/regression_problem.hpp"
#include "telltale/core/identification/identification.hpp"
#include "telltale/core/identification/options.hpp"
#include "telltale/core/identification/progress.hpp"
#include "telltale/core/vessel/vehicle.hpp"
#include "telltale/core/vessel/vessel_model.hpp"

namespace telltale {

/// Recording -> Identification: prepare, build the regressions, assess excitation, estimate,
/// quantify. Refuses when: the recording cannot be prepared, or not one equation can be answered.
/// An equation that alone cannot be estimated is left out and its refusal listed in the result, as
/// is that of the coverage check.
Result<Identification> Identify(const Recording& recording, const Vehicle& vehicle,
                                const IdentifyOptions& options, const Progress& progress = {});

/// The same from prepared data. For other estimators than kOneStep the data are prepared as
/// PrepareForWeakIv() does: in segments of about a minute and with a narrow filter. There is no
/// coverage check, which takes a recording.
Result<Identification> Identify(const PreparedDataset& dataset, const std::string& vehicle_id,
                                const IdentifyOptions& options, const Progress& progress = {});

/// ModelOf the same identification without the cost of its bounds; the dead zone is as given.
/// Refuses when: an equation cannot be answered.
Result<VesselModel> EstimateModel(const PreparedDataset& dataset,
                                  const RegressionOptions& regression,
                                  const ExcitationLimits& limits = {});

}  // namespace telltale
