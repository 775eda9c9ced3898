#include <algorithm>
#include <chrono>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>

#include "telltale/client/bus/participant.hpp"
#include "telltale/client/cli/commands.hpp"
#include "telltale/client/cli/fleet_answer.hpp"
#include "telltale/client/cli/live_options.hpp"
#include "telltale/client/fleet/vehicle_announcer.hpp"

namespace telltale {
namespace {

using Clock = std::chrono::steady_clock;

struct RetireArguments {
  std::string vehicle_id;
  LiveOptions live;
};

bool IsServed(const std::string& vehicle_id, const LiveOptions& live) {
  FleetRequest request;
  request.command = FleetCommand::kList;
  const FleetReply reply = AskFleet(request, live);
  RequireWholeFleet(request, reply);
  return std::ranges::find(reply.vehicles, vehicle_id, &VehicleSummary::vehicle_id) !=
         reply.vehicles.end();
}

/// The announcer stays until no daemon serves the boat: one that leaves may not have been heard.
void Retire(const RetireArguments& arguments) {
  const LiveOptions& live = arguments.live;
  const std::string& id = arguments.vehicle_id;
  const Participant participant(live.domain);
  VehicleAnnouncer announcer(participant, id);
  if (!announcer.WaitForReaders(live.Timeout())) {
    throw std::runtime_error("nobody hears announcements: " + NobodyThereAdvice(live.domain));
  }
  if (!IsServed(id, live)) throw std::runtime_error("no daemon serves " + id + ": telltale list");
  announcer.Retire();
  const auto deadline = Clock::now() + live.Timeout();
  while (IsServed(id, live)) {
    if (Clock::now() < deadline) continue;
    throw std::runtime_error(id + " is still served: the configuration of a daemon names it, or " +
                             "this client may not retire it, and its log says so");
  }
  std::cout << id << " is retired; its models stay stored\n";
}

}  // namespace

void AddRetire(CLI::App& telltale) {
  const auto arguments = std::make_shared<RetireArguments>();
  CLI::App& command =
      *telltale.add_subcommand("retire", "Takes a boat that has announced itself out of the fleet");
  AddVehicleId(command, arguments->vehicle_id)->required();
  arguments->live.AddTo(command, 10.0, "give up after this long");
  command.footer(
      "A boat that announces itself again joins the fleet again, with its models: end its\n"
      "telltale bridge --announce first.\n"
      "Example: telltale retire --vehicle-id boat-7");
  command.callback([arguments] { Retire(*arguments); });
}

}  // namespace telltale
