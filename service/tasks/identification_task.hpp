#pragma once

#include <optional>

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/samples.hpp"
#include "telltale/core/identification/identification.hpp"
#include "telltale/core/identification/progress.hpp"
#include "telltale/core/validation/promotion.hpp"
#include "telltale/core/vessel/vehicle.hpp"
#include "telltale/idl/codec/daemon_config.hpp"
#include "telltale/idl/codec/messages/exchange.hpp"
#include "telltale/service/models/free_run_error.hpp"

namespace telltale {

/// All that an identification is computed from, so that any process may do it.
struct IdentificationTask {
  IdentifyRequest request;
  IdentificationSettings settings;  ///< for what the request leaves open
  Vehicle vehicle;
  Recording recording;
};

/// What is computed of a model before it is published.
struct AssessedModel {
  Identification identification;
  Promotion promotion;
  std::optional<FreeRunError> reference_error;
};

/// Refuses as Identify() and IdentifyInChosenStructure().
Result<AssessedModel> Compute(const IdentificationTask& task, const Progress& progress);

}  // namespace telltale
