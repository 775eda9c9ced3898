#include "telltale/core/drift/run_errors.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "telltale/core/base/square.hpp"
#include "telltale/core/drift/drift_constants.hpp"
#include "telltale/core/simulation/divergence.hpp"
#include "telltale/core/simulation/free_run.hpp"
#include "telltale/core/validation/validation.hpp"

namespace telltale {
namespace {

constexpr Eigen::Index kWeatherTerms = 5;
constexpr Eigen::Index kCommandedTerms = 9;

/// By row, the velocities of the model along its segment, from the measured ones at its start.
std::vector<Nu> FollowCommands(const PreparedDataset& dataset, const VesselModel& model) {
  const ThrustHistory thrust = FollowThrust(dataset, model);
  std::vector<Nu> followed(dataset.rows.size());
  for (const RowRange& segment : dataset.segments) {
    if (segment.size() == 0) continue;
    const auto states = RunFreely(dataset, model, thrust, segment.begin, segment.size() - 1);
    for (std::size_t k = 0; k < states.size(); ++k) followed[segment.begin + k] = states[k].nu;
  }
  return followed;
}

Eigen::VectorXd WeatherTerms(const PreparedRow& row) {
  const double cosine = std::cos(row.eta.psi_rad);
  const double sine = std::sin(row.eta.psi_rad);
  Eigen::VectorXd terms(kWeatherTerms);
  terms << 1.0, cosine, sine, row.nu.r * cosine, row.nu.r * sine;
  return terms;
}

Eigen::VectorXd CommandedTerms(const PropellerCommand& delta, const Nu& nu) {
  const auto ahead = [](double side) { return Square(std::max(side, 0.0)); };
  const auto astern = [](double side) { return Square(std::min(side, 0.0)); };
  Eigen::VectorXd terms(kCommandedTerms);
  terms << ahead(delta.port), astern(delta.port), ahead(delta.starboard), astern(delta.starboard),
      nu.u, nu.v, nu.r, nu.u * nu.v, nu.u * nu.r;
  return terms;
}

/// The error of a run: means over all instants after the first.
RunError ErrorOf(const FreeRun& run, const PreparedDataset& dataset,
                 const std::vector<Nu>& followed) {
  RunError error;
  error.weather = Eigen::VectorXd::Zero(kWeatherTerms);
  error.commanded = Eigen::VectorXd::Zero(kCommandedTerms);
  const double share = 1.0 / static_cast<double>(run.predicted.size() - 1);
  for (std::size_t k = 1; k < run.predicted.size(); ++k) {
    const PreparedRow& row = dataset.rows[run.first_row + k];
    const Nu& nu = run.predicted[k].nu;
    const std::array<double, 3> beyond = {row.nu.u - nu.u, row.nu.v - nu.v, row.nu.r - nu.r};
    for (std::size_t i = 0; i < beyond.size(); ++i) {
      error.mean[i] += share * beyond[i];
      error.square[i] += share * Square(beyond[i]);
    }
    error.command.port += share * row.delta.port;
    error.command.starboard += share * row.delta.starboard;
    error.weather += share * WeatherTerms(row);
    error.commanded += share * CommandedTerms(row.delta, followed[run.first_row + k]);
  }
  return error;
}

/// Whether the errors are of a model that diverges, not of a boat that has lost its thrust: that
/// goes far slower than the model, yet not by more than the limits.
bool Diverges(const RunError& error, const Nu& limits) {
  const std::array<double, 3> limit = {limits.u, limits.v, limits.r};
  for (std::size_t i = 0; i < limit.size(); ++i) {
    if (!(std::sqrt(error.square[i]) < limit[i])) return true;  // NaN and infinity too
  }
  return !error.commanded.allFinite();
}

}  // namespace

std::vector<RunError> RunErrorsOf(const PreparedDataset& dataset,
                                  const Identification& identification, double from_s) {
  std::vector<RunError> errors;
  const auto model = ModelOf(identification);
  if (!model) return errors;
  const auto& physical = identification.physical;
  const auto runs = physical ? FreeRunsOf(dataset, *physical, kDrift.window_s)
                             : FreeRunsOf(dataset, AugmentedModel{*model, {}}, kDrift.window_s);
  if (!runs) return errors;
  const std::vector<Nu> followed = FollowCommands(dataset, *model);
  const Nu limits = kFreeRunDivergence.LimitsFor(FastestOf(dataset));
  for (const FreeRun& run : *runs) {
    if (dataset.rows[run.first_row].time_s < from_s) continue;
    RunError error = ErrorOf(run, dataset, followed);
    if (!Diverges(error, limits)) errors.push_back(std::move(error));
  }
  return errors;
}

}  // namespace telltale
