#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "telltale/client/cli/commands.hpp"
#include "telltale/client/cli/duration_text.hpp"
#include "telltale/client/cli/fleet_answer.hpp"
#include "telltale/client/cli/leave_note.hpp"
#include "telltale/client/cli/live_options.hpp"
#include "telltale/client/cli/output_options.hpp"
#include "telltale/client/cli/progress_line.hpp"
#include "telltale/client/cli/time_span.hpp"
#include "telltale/client/workbench/errors.hpp"
#include "telltale/idl/codec/json/fleet_answer.hpp"

namespace telltale {
namespace {

struct RefreshArguments {
  std::vector<std::string> vehicle_ids;
  bool all = false;
  std::string worse_than;
  std::string older_than;
  std::string follow;
  std::string cancel;
  OutputOptions output;
  LiveOptions live;
};

PromotionVerdict VerdictOf(const std::string& name) {
  if (name == "OK") return PromotionVerdict::kOk;
  return name == "WARN" ? PromotionVerdict::kWarn : PromotionVerdict::kUnknown;
}

FleetRequest RefreshRequestOf(const RefreshArguments& arguments) {
  FleetRequest request;
  request.correlation_id = NewCorrelationId();
  if (!arguments.follow.empty()) {
    request.command = FleetCommand::kFollow;
    request.target = arguments.follow;
    return request;
  }
  request.correlation_id.resize(12);  // short, since people type it
  request.command = FleetCommand::kRefresh;
  request.vehicle_ids = arguments.vehicle_ids;
  request.all = arguments.vehicle_ids.empty();
  request.worse_than = VerdictOf(arguments.worse_than);
  request.older_than_s = SecondsOf(arguments.older_than).value_or(0.0);
  return request;
}

/// What is said where the client leaves before the daemon has answered.
std::string UnconfirmedNote(const std::string& refresh_id) {
  return "the daemon has not confirmed the refresh; telltale refresh --follow " + refresh_id +
         "\ntells whether it is under way";
}

std::string GoesOnNote(const std::string& refresh_id) {
  return "the refresh goes on; telltale refresh --follow " + refresh_id +
         " shows it,\ntelltale refresh --cancel " + refresh_id + " ends it";
}

/// The vehicles of a refresh as they come: a line for each that is through, and the share of all.
class RefreshView {
 public:
  explicit RefreshView(bool lines) : lines_(lines) {}

  void Take(const FleetProgress& progress) {
    for (const RefreshedVehicle& vehicle : progress.vehicles) Take(vehicle);
    const auto through = static_cast<std::size_t>(
        std::ranges::count_if(states_, [](const auto& entry) { return IsFinal(entry.second); }));
    std::string running;
    for (const auto& [vehicle_id, state] : states_) {
      if (state == RefreshState::kRunning)
        running += (running.empty() ? ", now " : ", ") + vehicle_id;
    }
    // Each daemon that shares the fleet tells of its own boats, of all of them first.
    const std::size_t total = std::max<std::size_t>(progress.total, states_.size());
    line_.Update(std::to_string(through) + " of " + std::to_string(total) + " boats" + running,
                 total == 0 ? 1.0 : static_cast<double>(through) / static_cast<double>(total));
  }

 private:
  void Take(const RefreshedVehicle& vehicle) {
    RefreshState& state = states_[vehicle.vehicle_id];
    const bool through = IsFinal(vehicle.state) && !IsFinal(state);
    state = vehicle.state;
    if (through && lines_) Show(vehicle);
  }

  static void Show(const RefreshedVehicle& vehicle) {
    if (isatty(STDERR_FILENO)) std::cerr << kClearLine << std::flush;
    std::string text(Name(vehicle.state));
    if (vehicle.state == RefreshState::kPublished) {
      text += " revision " + std::to_string(vehicle.revision) + ' ' + VerdictText(vehicle.verdict);
    }
    std::cout << vehicle.vehicle_id << ": " << text << '\n' << std::flush;
  }

  bool lines_;
  std::map<std::string, RefreshState> states_;
  ProgressLine line_;
};

/// Exit 1 where a vehicle failed, 3 where one was refused or got a model with verdict ERROR.
void ThrowUnlessAllWell(const std::vector<RefreshedVehicle>& vehicles) {
  const auto count = [&](auto matches) {
    return std::to_string(std::ranges::count_if(vehicles, matches));
  };
  const auto failed = [](const RefreshedVehicle& vehicle) {
    return vehicle.state == RefreshState::kFailed || vehicle.state == RefreshState::kCancelled;
  };
  const auto refused = [](const RefreshedVehicle& vehicle) {
    return vehicle.state == RefreshState::kRefused || vehicle.verdict == PromotionVerdict::kError;
  };
  const std::string total = std::to_string(vehicles.size());
  if (std::ranges::any_of(vehicles, failed)) {
    throw std::runtime_error(count(failed) + " of " + total + " boats failed or were cancelled");
  }
  if (std::ranges::any_of(vehicles, refused)) {
    throw RefusedError({"refresh",
                        count(refused) + " of " + total + " boats have no sound new model",
                        "telltale identify --vehicle-id ID says what to record"});
  }
}

void Refresh(const RefreshArguments& arguments) {
  if (!arguments.cancel.empty()) {
    FleetRequest request;
    request.command = FleetCommand::kCancel;
    request.target = arguments.cancel;
    AskFleet(request, arguments.live);
    std::cout << "request " << arguments.cancel << " is cancelled\n";
    return;
  }
  const FleetRequest request = RefreshRequestOf(arguments);
  const std::string refresh_id =
      request.command == FleetCommand::kFollow ? request.target : request.correlation_id;
  LeaveNote note(UnconfirmedNote(refresh_id));
  if (request.command == FleetCommand::kRefresh) {
    std::cerr << "refresh " << refresh_id << "; elsewhere: telltale refresh --follow " << refresh_id
              << "\n"
              << std::flush;
  }
  auto view = std::make_unique<RefreshView>(!arguments.output.json);
  bool confirmed = false;
  const FleetReply reply = AskFleet(request, arguments.live, [&](const FleetProgress& progress) {
    if (!std::exchange(confirmed, true)) note.Change(GoesOnNote(refresh_id));
    view->Take(progress);
  });
  view.reset();
  arguments.output.Write(PrintRefreshJson(refresh_id, reply), [&] {
    if (reply.refreshed.empty()) return std::string("no boat meets the conditions\n");
    return std::to_string(reply.refreshed.size()) + " boats in " + DurationText(reply.elapsed_s) +
           ": " + RefreshSummaryText(reply.refreshed);
  });
  RequireWholeFleet(request, reply);
  ThrowUnlessAllWell(reply.refreshed);
}

CLI::Validator TimeSpanText() {
  return CLI::Validator(
      [](const std::string& text) {
        return SecondsOf(text)
                   ? std::string()
                   : text + " is no time span: 90s, 30min, 12h or 7d, at most 100 years";
      },
      "");
}

}  // namespace

void AddRefresh(CLI::App& telltale) {
  const auto arguments = std::make_shared<RefreshArguments>();
  CLI::App& command = *telltale.add_subcommand(
      "refresh", "Identifies many boats again, and shows what becomes of each");
  auto* const whom =
      command.add_option_group("whom", "one at least; conditions alone mean every boat");
  auto* const all = whom->add_flag("--all", arguments->all, "every boat that the daemon serves");
  whom->add_option("--vehicle-id", arguments->vehicle_ids, "these boats")
      ->type_name("ID")
      ->check(IdentifierText())
      ->excludes(all);
  whom->add_option("--worse-than", arguments->worse_than,
                   "boats without a model, or whose model has a worse verdict: OK means WARN and "
                   "ERROR, WARN means ERROR")
      ->check(CLI::IsMember({"OK", "WARN"}));
  whom->add_option("--older-than", arguments->older_than,
                   "boats without a model, or whose model is older: 90s, 30min, 12h, 7d")
      ->type_name("SPAN")
      ->check(TimeSpanText());
  whom->add_option("--follow", arguments->follow, "show a refresh that another terminal began")
      ->type_name("REFRESH")
      ->check(IdentifierText());
  whom->add_option("--cancel", arguments->cancel, "end a refresh, or another request by its id")
      ->type_name("REFRESH")
      ->check(IdentifierText());
  whom->require_option(1, 0);
  arguments->output.AddTo(command, "the summary");
  arguments->live.AddTo(command, 3600.0, "give up after this long; the refresh goes on");
  command.footer(
      "A boat is UNCHANGED where no telemetry has come since its model was made.\n"
      "Ctrl-C leaves the refresh under way, and says how to follow or cancel it.\n"
      "Exit codes: 3 where a boat was refused or its model has verdict ERROR, 1 where one failed.\n"
      "Example: telltale refresh --older-than 7d");
  command.callback([arguments] {
    const bool other = !arguments->follow.empty() || !arguments->cancel.empty();
    const bool begins = arguments->all || !arguments->vehicle_ids.empty() ||
                        !arguments->worse_than.empty() || !arguments->older_than.empty();
    if (other && (begins || (!arguments->follow.empty() && !arguments->cancel.empty()))) {
      throw UsageError("--follow and --cancel stand alone");
    }
    Refresh(*arguments);
  });
}

}  // namespace telltale
