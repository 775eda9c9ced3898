#include "telltale/core/diagnosis/residuals/wiring_check.hpp"

#include <array>
#include <string>
#include <string_view>

#include "telltale/core/diagnosis/diagnosis_constants.hpp"
#include "telltale/core/diagnosis/residuals/free_runs.hpp"

namespace telltale {
namespace {

constexpr double kHorizonS = kDiagnosis.horizons.main_s;
// Of the squared error: no other fault is mended like this by exchanging commands.
constexpr double kMaximumErrorRatio = kDiagnosis.wiring.maximum_error_ratio;

struct Wiring {
  std::string_view fault;
  PropellerCommand (*undo)(const PropellerCommand&);
};

constexpr std::array kWirings = {
    Wiring{"port and starboard seem to be swapped",
           [](const PropellerCommand& d) {
             return PropellerCommand{d.starboard, d.port};
           }},
    Wiring{"the port thruster seems to be reversed",
           [](const PropellerCommand& d) {
             return PropellerCommand{-d.port, d.starboard};
           }},
    Wiring{"the starboard thruster seems to be reversed",
           [](const PropellerCommand& d) {
             return PropellerCommand{d.port, -d.starboard};
           }},
    Wiring{"both thrusters seem to be reversed",
           [](const PropellerCommand& d) {
             return PropellerCommand{-d.port, -d.starboard};
           }},
    Wiring{"port and starboard seem to be swapped, and both reversed",
           [](const PropellerCommand& d) {
             return PropellerCommand{-d.starboard, -d.port};
           }},
};

/// Along (m), across (m) and heading (rad, at a metre) alike; errors are cut at one.
double SquaredError(const PreparedDataset& recording, const VesselModel& model) {
  const FreeRuns runs(recording, model, kHorizonS);
  const Eigen::MatrixXd errors = runs.Errors({model, {}})
                                     .cwiseMin(kDiagnosis.wiring.largest_error)
                                     .cwiseMax(-kDiagnosis.wiring.largest_error);
  return errors.squaredNorm();
}

}  // namespace

std::optional<Refusal> SuspectedWiringFault(const PreparedDataset& recording,
                                            const VesselModel& model) {
  const double as_wired = SquaredError(recording, model);
  for (const Wiring& wiring : kWirings) {
    PreparedDataset rewired = recording;
    for (HeldCommands& commands : rewired.commands) commands.ForEachCommand(wiring.undo);
    if (SquaredError(rewired, model) > kMaximumErrorRatio * as_wired) continue;
    return Refusal{"thrusters", std::string(wiring.fault),
                   "check the vehicle file's port and starboard channels, and the wiring; with "
                   "commands so changed the model follows the recording"};
  }
  return std::nullopt;
}

}  // namespace telltale
