#include <chrono>
#include <iostream>
#include <memory>
#include <optional>

#include "bus/participant.hpp"
#include "cli/commands.hpp"
#include "cli/live_options.hpp"
#include "cli/model_table.hpp"
#include "cli/published_model.hpp"
#include "fleet/subscriber.hpp"

namespace telltale {
namespace {

using Clock = std::chrono::steady_clock;

struct WatchArguments {
  std::string vehicle_id;
  bool all = false;
  std::size_t count = 0;
  bool json = false;
  LiveOptions live;
};

void Print(const PublishedModel& model, bool json) {
  if (json) {
    std::cout << PrintModelJson(model) << std::flush;
    return;
  }
  std::cout << model.identification.vehicle_id << ", revision " << model.revision << "\n\n"
            << ModelTable(model.identification) << '\n'
            << std::flush;
}

void Watch(const WatchArguments& arguments) {
  const Participant participant(arguments.live.domain);
  std::size_t seen = 0;
  const auto enough = [&] { return arguments.count > 0 && seen >= arguments.count; };
  ModelSubscriber models(
      participant,
      [&](const PublishedModel& model) {
        if (enough()) return;
        if (!arguments.all && model.identification.vehicle_id != arguments.vehicle_id) return;
        Print(model, arguments.json);
        ++seen;
      },
      [](const CodecError& error) {
        std::cerr << "telltale: a model was set aside: " << error.Message() << '\n';
      });

  const bool patient = arguments.live.timeout_s == 0.0;
  const auto deadline = Clock::now() + arguments.live.Timeout();
  while (!enough()) {
    const auto left = deadline - Clock::now();
    if (!patient && left <= left.zero()) {
      throw std::runtime_error(
          "only " + std::to_string(seen) + " models came in time" +
          (models.Connected() ? "" : ": " + NobodyThereAdvice(arguments.live.domain)));
    }
    models.Wait(patient ? std::chrono::hours(1) : left);
  }
}

}  // namespace

void AddWatch(CLI::App& telltale) {
  const auto arguments = std::make_shared<WatchArguments>();
  CLI::App& command = *telltale.add_subcommand(
      "watch",
      "Follows published models and their bounds, beginning with the last of each vehicle");
  auto* const whom = command.add_option_group("whom");
  AddVehicleId(*whom, arguments->vehicle_id);
  whom->add_flag("--all", arguments->all, "every vehicle");
  whom->require_option(1);
  command.add_option("--count", arguments->count, "stop after this many models, 0 for never")
      ->type_name("N")
      ->capture_default_str();
  command.add_flag("--json", arguments->json, "print each model as JSON");
  arguments->live.AddTo(command, 0.0, "give up after this long, 0 for never");
  command.footer("Example: telltale watch --all --count 1");
  command.callback([arguments] { Watch(*arguments); });
}

}  // namespace telltale
