#include <iostream>
#include <string>

#include "telltale/client/bridge/mavlink_source.hpp"
#include "telltale/client/bus/participant.hpp"
#include "telltale/client/cli/announce.hpp"
#include "telltale/client/cli/bridge_commands.hpp"
#include "telltale/client/cli/bridge_rates.hpp"
#include "telltale/client/cli/table.hpp"

namespace telltale {
namespace {

std::vector<BridgedVehicle> VehiclesOf(const MavlinkBridge& bridge) {
  std::vector<BridgedVehicle> vehicles;
  for (const MavlinkVehicleCounts& one : bridge.Counts()) {
    vehicles.push_back({one.vehicle_id, one.published,
                        std::to_string(one.lost_frames) + " lost, " +
                            std::to_string(Total(one.rejected)) + " rejected"});
  }
  return vehicles;
}

void PrintSummary(const MavlinkBridge& bridge) {
  Table table({{"vehicle"},
               {"system", Align::kRight},
               {"positions", Align::kRight},
               {"headings", Align::kRight},
               {"commands", Align::kRight},
               {"lost frames", Align::kRight},
               {"rejected", Align::kRight}});
  std::string notes;
  for (const MavlinkVehicleCounts& one : bridge.Counts()) {
    table.AddRow({one.vehicle_id, std::to_string(one.system), std::to_string(one.published[0]),
                  std::to_string(one.published[1]), std::to_string(one.published[2]),
                  std::to_string(one.lost_frames), std::to_string(Total(one.rejected))});
    const std::string whose = one.vehicle_id + ": ";
    for (const MavlinkReject reason : kMavlinkRejects) {
      notes += CountNote(whose, one.rejected[static_cast<std::size_t>(reason)], Name(reason));
    }
    notes += CountNote(whose, one.other_sender, "frames of another sender with its system id");
    notes += CountNote(whose, one.denied, "requests for message intervals denied");
  }
  notes += CountNote("", bridge.Damage().corrupt_frames, "messages with a wrong checksum");
  notes += CountNote("", bridge.Damage().skipped_bytes + bridge.Damage().truncated_bytes,
                     "bytes that are no MAVLink");
  std::cout << (bridge.Counts().empty() ? "No vehicle was heard.\n" : table.Render()) << notes;
}

}  // namespace

void BridgeMavlink(const MavlinkAddress& address, const MavlinkBridgeOptions& options,
                   const std::vector<Vehicle>& announced, std::uint32_t domain) {
  BridgeRates rates;
  const auto report = [&](const std::string& what) { rates.Report(what); };
  const Participant participant(domain);
  const auto announcers = Announce(participant, announced);
  MavlinkSource source(participant, address, options, report);
  report("waiting for MAVLink");
  RunUntilSignal(source, rates, [&] { return VehiclesOf(source.Bridge()); });
  PrintSummary(source.Bridge());
}

}  // namespace telltale
