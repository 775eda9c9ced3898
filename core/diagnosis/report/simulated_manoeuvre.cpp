#include "telltale/core/diagnosis/report/simulated_manoeuvre.hpp"

#include <algorithm>
#include <utility>

#include "telltale/core/data/preparation.hpp"
#include "telltale/core/diagnosis/diagnosis_constants.hpp"
#include "telltale/core/simulation/divergence.hpp"
#include "telltale/core/simulation/sensors.hpp"
#include "telltale/core/simulation/simulator.hpp"

namespace telltale {
namespace {

bool HasDiverged(const TimedState& now) {
  return kSimulatedManoeuvreDivergence.Exceeds(now.state.nu);
}

}  // namespace

std::optional<PreparedDataset> SimulatedManoeuvre(const CatalogueManoeuvre& manoeuvre,
                                                  const VesselModel& model,
                                                  double sampling_period_s,
                                                  const HullParticulars& hull) {
  constexpr double kCruise = kDiagnosis.separation.cruise_command;
  constexpr double kCruiseS = kDiagnosis.separation.cruise_s;
  VesselModel carrier = model;
  carrier.structure = Structure::kStaticQuadratic;
  carrier.discretisation = Discretisation::kContinuous;
  Vehicle vehicle{"simulated", 1.0, {}, {}, {}, std::nullopt};
  vehicle.hull = hull;
  const auto commands =
      Schedule({Manoeuvre{{{kCruise, kCruise}, kCruiseS}}, manoeuvre.manoeuvre}, 0.0);
  const double end_s = kCruiseS + kCatalogueDurationS;
  const auto track = Simulate(carrier, {}, commands, end_s, sampling_period_s / 10.0);
  if (std::any_of(track.begin(), track.end(), HasDiverged)) return std::nullopt;
  SensorOptions sensors;
  sensors.position_noise_m = 0.0;
  sensors.heading_noise_deg = 0.0;
  PrepareOptions options;
  options.sampling_period_s = sampling_period_s;
  auto dataset = Prepare(Measure(track, vehicle, sensors), vehicle, options);
  if (!dataset) return std::nullopt;
  return *std::move(dataset);
}

}  // namespace telltale
