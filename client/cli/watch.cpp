#include <chrono>
#include <functional>
#include <iostream>
#include <memory>
#include <string>
#include <utility>

#include "telltale/client/bus/participant.hpp"
#include "telltale/client/bus/wait_set.hpp"
#include "telltale/client/cli/commands.hpp"
#include "telltale/client/cli/live_options.hpp"
#include "telltale/client/cli/model_table.hpp"
#include "telltale/client/cli/promotion_text.hpp"
#include "telltale/client/fleet/subscriber.hpp"
#include "telltale/idl/codec/json/published.hpp"

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
  std::cout << model.identification.vehicle_id << ", revision " << model.revision << '\n'
            << PromotionText(model.promotion) << '\n'
            << ModelTable(model.identification) << '\n'
            << std::flush;
}

void Print(const PublishedDiagnosis& published, bool json) {
  if (json) {
    std::cout << PrintReportJson(published) << std::flush;
    return;
  }
  std::cout << published.diagnosis.vehicle_id << ", revision " << published.model_revision
            << " diagnosed: " << published.diagnosis.sentence << '\n'
            << std::flush;
}

std::function<void(const CodecError&)> ReportUnreadable(std::string what) {
  return [what = std::move(what)](const CodecError& error) {
    std::cerr << "telltale: " << what << " is rejected: " << error.Message() << '\n';
  };
}

void Watch(const WatchArguments& arguments) {
  const Participant participant(arguments.live.domain);
  std::size_t seen = 0;
  const auto enough = [&] { return arguments.count > 0 && seen >= arguments.count; };
  const auto show = [&](const std::string& vehicle_id, const auto& published) {
    if (enough()) return;
    if (!arguments.all && vehicle_id != arguments.vehicle_id) return;
    Print(published, arguments.json);
    ++seen;
  };
  WaitSet wait_set(participant);
  const ModelSubscription models(
      participant, wait_set,
      [&](const PublishedModel& model) { show(model.identification.vehicle_id, model); },
      ReportUnreadable("a model"));
  const DiagnosisSubscription diagnoses(
      participant, wait_set,
      [&](const PublishedDiagnosis& published) { show(published.diagnosis.vehicle_id, published); },
      ReportUnreadable("a diagnosis"));

  const bool without_timeout = arguments.live.timeout_s == 0.0;
  const auto deadline = Clock::now() + arguments.live.Timeout();
  while (!enough()) {
    const auto left = deadline - Clock::now();
    if (!without_timeout && left <= left.zero()) {
      throw std::runtime_error(
          "only " + std::to_string(seen) + " models and diagnoses came in time" +
          (models.Connected() ? "" : ": " + NobodyThereAdvice(arguments.live.domain)));
    }
    wait_set.Wait(without_timeout ? std::chrono::hours(1) : left);
  }
}

}  // namespace

void AddWatch(CLI::App& telltale) {
  const auto arguments = std::make_shared<WatchArguments>();
  CLI::App& command = *telltale.add_subcommand(
      "watch",
      "Follows published models, their bounds, and diagnoses, beginning with the last of each "
      "vehicle");
  auto* const whom = command.add_option_group("whom");
  AddVehicleId(*whom, arguments->vehicle_id);
  whom->add_flag("--all", arguments->all, "every vehicle");
  whom->require_option(1);
  command
      .add_option("--count", arguments->count,
                  "stop after this many models and diagnoses, 0 for never")
      ->type_name("N")
      ->capture_default_str();
  command.add_flag("--json", arguments->json,
                   "print each model and diagnosis as JSON: model.json, report.json");
  arguments->live.AddTo(command, 0.0, "give up after this long, 0 for never");
  command.footer("Example: telltale watch --all --count 1");
  command.callback([arguments] { Watch(*arguments); });
}

}  // namespace telltale
