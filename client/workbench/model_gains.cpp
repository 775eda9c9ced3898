#include "telltale/client/workbench/model_gains.hpp"

#include <utility>

namespace telltale {

ModelGains GainsOf(const Identification& model, std::vector<PropellerCommand> commands) {
  if (commands.empty()) {
    commands = {{1.0, 1.0}, {0.5, 0.5}, {0.8, 0.4}, {0.4, 0.8}, {0.5, -0.5}, {-0.5, 0.5}};
  }
  ModelGains of{WithSimulationParameters(model), {}};
  for (const PropellerCommand& delta : commands) {
    of.gains.push_back({delta, SteadyInputGain(of.model, delta)});
  }
  return of;
}

}  // namespace telltale
