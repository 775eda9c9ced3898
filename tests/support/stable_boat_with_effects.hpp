#pragma once

#include <string>
#include <vector>

#include "support/stable_boat.hpp"
#include "telltale/core/data/preparation.hpp"
#include "telltale/core/effects/augmented_simulation.hpp"
#include "telltale/core/identification/identification.hpp"

namespace telltale::testing {

/// The stable boat with effects, simulated and measured by RTK-like sensors, prepared.
inline PreparedDataset SimulateWithEffects(const std::vector<ModelledEffect>& effects,
                                           double duration_s, std::uint64_t seed) {
  const AugmentedModel boat{StableBoat(), effects};
  SensorOptions sensors;
  sensors.seed = seed;
  const auto track = Simulate(boat, VariedCommands(duration_s, seed), duration_s, 0.05);
  PrepareOptions options;
  options.sampling_period_s = 0.2;
  return Prepare(Measure(track, boat, StableBoatVehicle(), sensors), StableBoatVehicle(), options)
      .value();
}

/// The stable boat's model as if it had been identified, each coefficient known to two hundredths
/// of the largest of its equation.
inline Identification KnownStableBoat() {
  const VesselModel model = StableBoat();
  Identification known;
  known.vehicle_id = "stable";
  known.structure = model.structure;
  known.parameterization = model.parameterization;
  known.estimator = Estimator::kWeakIv;
  known.sampling_period_s = model.sampling_period_s;
  for (const Equation equation : kEquations) {
    const Eigen::VectorXd& theta = model.theta[IndexOf(equation)];
    const auto regressors = Regressors(equation, model.parameterization);
    const double error = 0.02 * theta.cwiseAbs().maxCoeff();
    for (Eigen::Index i = 0; i < theta.size(); ++i) {
      const Regressor& regressor = regressors[static_cast<std::size_t>(i)];
      known.coefficients.push_back({equation, std::string(regressor.name),
                                    std::string(regressor.symbol), theta[i], error,
                                    NormalInterval(theta[i], error, 0.95),
                                    std::string(regressor.unit), CoefficientStatus::kEstimated});
    }
  }
  const auto size = static_cast<Eigen::Index>(known.coefficients.size());
  known.covariance = Eigen::MatrixXd::Zero(size, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    const double error = known.coefficients[static_cast<std::size_t>(i)].standard_error;
    known.covariance(i, i) = error * error;
  }
  return known;
}

}  // namespace telltale::testing
