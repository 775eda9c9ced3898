#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "support/stable_boat.hpp"
#include "telltale/core/data/preparation.hpp"
#include "telltale/core/effects/augmented_simulation.hpp"
#include "telltale/core/identification/identification.hpp"
#include "telltale/core/uncertainty/interval.hpp"

namespace telltale::testing {

inline constexpr double kPhysicalBoatSeparation = 0.7;

/// A made-up catamaran in Fossen's form, every parameter but the delays at work.
inline FossenVector PhysicalBoat() {
  FossenVector p;
  p << 1.5, 0.03, 0.18, 0.15, 0.45, 1.2, 0.05, -0.05, 0.25, 1.5, 0.4, -0.1, 0.05, 0.2, 0.3, 0.1,
      -0.1, 0.1, 0.5, 1.6, 0.4, 1.2, 0.5, 0.04, 0.06, 0.08, 0.25, 0.0, 0.0;
  return p;
}

/// The model of these parameters as if it had been identified, each known to a share of itself.
inline Identification KnownPhysicalBoat(const FossenVector& parameters, double relative_error) {
  Identification known;
  known.vehicle_id = "stable";
  known.structure = Structure::kFossen;
  known.parameterization = Parameterization::kPropeller;
  known.estimator = Estimator::kPredictionError;
  known.sampling_period_s = 0.2;
  known.dead_zone = DeadZoneOf(parameters);
  PhysicalModel physical;
  physical.propeller_separation_m = kPhysicalBoatSeparation;
  physical.covariance = Eigen::MatrixXd::Zero(kFossenParameters, kFossenParameters);
  for (std::size_t i = 0; i < kFossenParameters; ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const FossenParameterName& name = FossenParameterNames()[i];
    const double error = relative_error * std::abs(parameters[at]);
    physical.covariance(at, at) = error * error;
    physical.parameters.push_back({Equation::kUnknown, "", std::string(name.symbol), parameters[at],
                                   error, NormalInterval(parameters[at], error, 0.95),
                                   std::string(name.unit), CoefficientStatus::kEstimated});
  }
  const Eigen::VectorXd implied = CoefficientsOf(parameters, kPhysicalBoatSeparation);
  Eigen::Index at = 0;
  for (const Equation equation : kEquations) {
    for (const Regressor& regressor : Regressors(equation, known.parameterization)) {
      known.coefficients.push_back({equation, std::string(regressor.name),
                                    std::string(regressor.symbol), implied[at], 0.0,
                                    NormalInterval(implied[at], 0.0, 0.95),
                                    std::string(regressor.unit), CoefficientStatus::kEstimated});
      ++at;
    }
  }
  known.covariance = Eigen::MatrixXd::Zero(at, at);
  known.thruster_time_constant =
      physical.parameters[static_cast<std::size_t>(At(FossenParameter::kTimeConstant))];
  known.physical = std::move(physical);
  return known;
}

/// Simulated and measured by RTK-like sensors, prepared.
inline PreparedDataset SimulatePhysicalBoat(const FossenVector& parameters, double duration_s,
                                            std::uint64_t seed,
                                            const std::vector<ModelledEffect>& effects = {}) {
  VesselModel model = VesselModelOf(parameters, kPhysicalBoatSeparation);
  model.sampling_period_s = 0.2;
  const AugmentedModel boat{model, effects};
  SensorOptions sensors;
  sensors.seed = seed;
  PrepareOptions options;
  options.sampling_period_s = 0.2;
  const auto track = Simulate(boat, VariedCommands(duration_s, seed), duration_s, 0.05);
  return Prepare(Measure(track, boat, StableBoatVehicle(), sensors), StableBoatVehicle(), options)
      .value();
}

}  // namespace telltale::testing
