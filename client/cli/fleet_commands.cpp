#include <memory>
#include <string>

#include "telltale/client/cli/commands.hpp"
#include "telltale/client/cli/fleet_answer.hpp"
#include "telltale/client/cli/live_options.hpp"
#include "telltale/client/cli/output_options.hpp"
#include "telltale/client/cli/whole_number.hpp"
#include "telltale/idl/codec/json/fleet_answer.hpp"

namespace telltale {
namespace {

constexpr double kAnswerTimeoutS = 30.0;

struct FleetArguments {
  std::string vehicle_id;
  std::uint64_t revision = 0;
  OutputOptions output;
  LiveOptions live;

  void AddTo(CLI::App& command, const std::string& file_name) {
    output.AddTo(command, file_name);
    live.AddTo(command, kAnswerTimeoutS, "give up after this long");
  }
};

void List(const FleetArguments& arguments) {
  FleetRequest request;
  request.command = FleetCommand::kList;
  const FleetReply reply = AskFleet(request, arguments.live);
  arguments.output.Write(PrintVehicleListJson(reply.vehicles),
                         [&] { return VehicleListTable(reply.vehicles); });
  RequireWholeFleet(request, reply);
}

void History(const FleetArguments& arguments) {
  FleetRequest request;
  request.command = FleetCommand::kHistory;
  request.vehicle_ids = {arguments.vehicle_id};
  const FleetReply reply = AskFleet(request, arguments.live);
  arguments.output.Write(PrintModelHistoryJson(arguments.vehicle_id, reply.models), [&] {
    return reply.models.empty() ? arguments.vehicle_id + " has no model yet: telltale identify " +
                                      "--vehicle-id " + arguments.vehicle_id + '\n'
                                : ModelHistoryTable(reply.models);
  });
}

void Rollback(const FleetArguments& arguments) {
  FleetRequest request;
  request.command = FleetCommand::kRollback;
  request.vehicle_ids = {arguments.vehicle_id};
  request.revision = arguments.revision;
  const FleetReply reply = AskFleet(request, arguments.live);
  arguments.output.Write(PrintModelHistoryJson(arguments.vehicle_id, reply.models), [&] {
    return "revision " + std::to_string(arguments.revision) + " of " + arguments.vehicle_id +
           " is published again as revision " +
           std::to_string(reply.models.empty() ? 0 : reply.models.front().revision) + '\n';
  });
}

}  // namespace

void AddList(CLI::App& telltale) {
  const auto arguments = std::make_shared<FleetArguments>();
  CLI::App& command = *telltale.add_subcommand(
      "list", "Lists the boats that the daemon serves, with their newest models");
  arguments->AddTo(command, "the list");
  command.footer(
      "verdict: OK, or WARN or ERROR with the reason below the table.\n"
      "Example: telltale list");
  command.callback([arguments] { List(*arguments); });
}

void AddHistory(CLI::App& telltale) {
  const auto arguments = std::make_shared<FleetArguments>();
  CLI::App& command = *telltale.add_subcommand(
      "history", "Lists the models of a boat that the daemon keeps, newest first");
  AddVehicleId(command, arguments->vehicle_id)->required();
  arguments->AddTo(command, "the models");
  command.footer("Example: telltale history --vehicle-id blueboat-1");
  command.callback([arguments] { History(*arguments); });
}

void AddRollback(CLI::App& telltale) {
  const auto arguments = std::make_shared<FleetArguments>();
  CLI::App& command = *telltale.add_subcommand(
      "rollback", "Publishes an earlier model of a boat again, as a new revision");
  AddVehicleId(command, arguments->vehicle_id)->required();
  command.add_option("--revision", arguments->revision, "the model to publish again")
      ->type_name("N")
      ->check(WholeNumber())
      ->required();
  arguments->AddTo(command, "the new revision");
  command.footer(
      "telltale history lists the revisions that are kept.\n"
      "Example: telltale rollback --vehicle-id blueboat-1 --revision 7");
  command.callback([arguments] { Rollback(*arguments); });
}

}  // namespace telltale
