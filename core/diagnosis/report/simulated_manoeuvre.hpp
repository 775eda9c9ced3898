#pragma once

#include <optional>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/simulation/manoeuvre_catalogue.hpp"
#include "telltale/core/simulation/manoeuvres.hpp"
#include "telltale/core/vessel/vehicle.hpp"
#include "telltale/core/vessel/vessel_model.hpp"

namespace telltale {

/// A prepared recording of a catalogue manoeuvre, simulated by the model without noise after ten
/// seconds of straight cruise. Thrust follows commands at once, since windows take only commands
/// and starting states from it. The dataset carries the hull. None where the simulation exceeds the
/// limits of kDiagnosis.separation.
std::optional<PreparedDataset> SimulatedManoeuvre(const CatalogueManoeuvre& manoeuvre,
                                                  const VesselModel& model,
                                                  double sampling_period_s,
                                                  const HullParticulars& hull);

}  // namespace telltale
