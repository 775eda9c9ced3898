#include <iostream>
#include <string>

#include "telltale/client/bus/participant.hpp"
#include "telltale/client/cli/announce.hpp"
#include "telltale/client/cli/bridge_commands.hpp"
#include "telltale/client/cli/bridge_rates.hpp"
#include "telltale/client/cli/table.hpp"

namespace telltale {
namespace {

std::vector<BridgedVehicle> VehiclesOf(const Ros2Bridge& bridge) {
  std::vector<BridgedVehicle> vehicles;
  for (const RosVehicleCounts& one : bridge.Counts()) {
    vehicles.push_back(
        {one.vehicle_id, one.published, std::to_string(Total(one.rejected)) + " rejected"});
  }
  return vehicles;
}

void PrintSummary(const Ros2Bridge& bridge) {
  Table table({{"vehicle"},
               {"positions", Align::kRight},
               {"headings", Align::kRight},
               {"commands", Align::kRight},
               {"rejected", Align::kRight}});
  std::string notes;
  for (const RosVehicleCounts& one : bridge.Counts()) {
    table.AddRow({one.vehicle_id, std::to_string(one.published[0]),
                  std::to_string(one.published[1]), std::to_string(one.published[2]),
                  std::to_string(Total(one.rejected))});
    for (const RosReject reason : kRosRejects) {
      notes += CountNote(one.vehicle_id + ": ", one.rejected[static_cast<std::size_t>(reason)],
                         Name(reason));
    }
  }
  std::cout << (bridge.Counts().empty() ? "No vehicle was heard.\n" : table.Render()) << notes;
}

}  // namespace

void BridgeRos2(const Ros2SourceOptions& options, const std::vector<Vehicle>& announced,
                std::uint32_t domain) {
  BridgeRates rates;
  const auto report = [&](const std::string& what) { rates.Report(what); };
  const Participant participant(domain);
  const auto announcers = Announce(participant, announced);
  Ros2Source source(participant, options, report);
  report("waiting for topics of ROS 2");
  RunUntilSignal(source, rates, [&] { return VehiclesOf(source.Bridge()); });
  PrintSummary(source.Bridge());
}

}  // namespace telltale
