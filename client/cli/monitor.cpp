#include <chrono>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <unistd.h>

#include "telltale/client/bus/participant.hpp"
#include "telltale/client/bus/reader.hpp"
#include "telltale/client/bus/wait_set.hpp"
#include "telltale/client/cli/commands.hpp"
#include "telltale/client/cli/live_options.hpp"
#include "telltale/client/cli/quality_rounds.hpp"
#include "telltale/client/cli/quality_table.hpp"
#include "telltale/client/fleet/unix_now.hpp"
#include "telltale/idl/codec/json/quality.hpp"
#include "telltale/idl/codec/wire/quality.hpp"

namespace telltale {
namespace {

using Clock = std::chrono::steady_clock;

struct MonitorArguments {
  bool once = false;
  bool json = false;
  std::size_t count = 0;
  std::string vehicle_id;
  QualityView view;
  LiveOptions live;
};

/// One line a vehicle.
std::string JsonLines(const std::vector<Quality>& shown) {
  std::string lines;
  for (const Quality& quality : shown) lines += PrintQualityLine(quality, UnixNow()) + '\n';
  return lines;
}

/// The vehicle asked for. Throws where the daemon serves none of that id.
const Quality& Named(const std::map<std::string, Quality>& fleet, const std::string& vehicle_id) {
  const auto named = fleet.find(vehicle_id);
  if (named != fleet.end()) return named->second;
  std::string served;
  for (const auto& [id, quality] : fleet) {
    if (id != kUnattributed) served += (served.empty() ? "" : ", ") + id;
  }
  throw std::runtime_error("no daemon on this domain serves '" + vehicle_id +
                           "'; served: " + served);
}

std::string Rendered(const std::map<std::string, Quality>& fleet,
                     const MonitorArguments& arguments) {
  if (arguments.vehicle_id.empty()) {
    if (arguments.json) return JsonLines(Selected(fleet, arguments.view));
    return QualityTable(fleet, arguments.view) + '\n';
  }
  const Quality& quality = Named(fleet, arguments.vehicle_id);
  if (arguments.json) return JsonLines({quality});
  return QualityDetail(quality, UnixNow()) + '\n';
}

/// Whether enough time has passed since the last JSON: a line a vehicle and second, however often
/// a daemon reports.
class JsonPace {
 public:
  bool IsDue() {
    const auto now = Clock::now();
    if (now < next_) return false;
    next_ = now + std::chrono::milliseconds(990);
    return true;
  }

 private:
  Clock::time_point next_;
};

void Monitor(const MonitorArguments& arguments) {
  const Participant participant(arguments.live.domain);
  QualityRounds rounds;
  Reader<telltale_wire_Quality> reports(participant);
  WaitSet wait_set(participant);
  wait_set.Attach(reports, [&] {
    reports.Take([&](const telltale_wire_Quality& wire, WriterHandle daemon) {
      const auto quality = Decode(wire);
      if (quality) return rounds.Take(*quality, daemon);
      std::cerr << "telltale: a report is rejected: " << quality.error().Message() << '\n';
    });
  });

  const std::size_t wanted = arguments.once ? 1 : arguments.count;
  const bool redraw = wanted != 1 && !arguments.json && isatty(STDOUT_FILENO) == 1;
  JsonPace pace;
  std::size_t seen = 0;
  std::size_t shown = 0;
  auto deadline = Clock::now() + arguments.live.Timeout();
  while (wanted == 0 || shown < wanted) {
    if (Clock::now() >= deadline) {
      throw std::runtime_error("no reports of a daemon: " +
                               NobodyThereAdvice(arguments.live.domain));
    }
    wait_set.Wait(deadline - Clock::now());
    if (rounds.complete() == seen) continue;
    seen = rounds.complete();
    deadline = Clock::now() + arguments.live.Timeout();
    if (arguments.json && !pace.IsDue()) continue;
    ++shown;
    std::cout << (redraw ? "\x1b[H\x1b[2J" : "") << Rendered(rounds.fleet(), arguments)
              << std::flush;
  }
}

/// Takes a name, in any case, for its value. CLI::CheckedTransformer also takes the values' numbers
/// and shows them in its error.
template <class Enum>
void TakeNames(const CLI::TransformPairs<Enum>& values, CLI::Option& option) {
  // What is added last comes first.
  option.transform(CLI::Transformer(values, CLI::ignore_case).description(""));
  option.transform(CLI::IsMember(values, CLI::ignore_case).description(""));
}

void AddViewOptions(CLI::App& command, MonitorArguments& arguments) {
  CLI::Option& order = *command.add_option("--sort", arguments.view.order,
                                           "urgency (the default), id, error, fill, age");
  TakeNames<QualityOrder>({{"urgency", QualityOrder::kUrgency},
                           {"id", QualityOrder::kId},
                           {"error", QualityOrder::kError},
                           {"fill", QualityOrder::kFill},
                           {"age", QualityOrder::kAge}},
                          *order.type_name("ORDER"));
  CLI::TransformPairs<QualityVerdict> verdicts;
  for (const QualityVerdict verdict : kQualityVerdicts) {
    verdicts.emplace_back(Name(verdict), verdict);
  }
  CLI::Option& verdict = *command.add_option(
      "--verdict", arguments.view.verdicts, "only boats with one of these: OK, WARN, ERROR, STALE");
  TakeNames(verdicts, *verdict.type_name("VERDICT,...")->delimiter(','));
  command.add_option("--match", arguments.view.match, "only boats whose id holds this text")
      ->type_name("TEXT");
}

}  // namespace

void AddMonitor(CLI::App& telltale) {
  const auto arguments = std::make_shared<MonitorArguments>();
  CLI::App& command = *telltale.add_subcommand(
      "monitor", "Shows how telemetry and models are doing across the fleet, live");
  auto* const once = command.add_flag("--once", arguments->once, "show one table and stop");
  command.add_option("--count", arguments->count, "stop after this many tables, 0 for never")
      ->type_name("N")
      ->capture_default_str()
      ->excludes(once);
  AddViewOptions(command, *arguments);
  AddVehicleId(command, arguments->vehicle_id)->description("everything about this boat alone");
  command.add_flag("--json", arguments->json, "a line of JSON a boat and second");
  arguments->live.AddTo(command, 10.0, "give up when no report comes for this long");
  command.footer(
      "verdict: OK, WARN, ERROR, STALE (no telemetry); the reasons stand below the table.\n"
      "f/h/t Hz: fixes, headings, thruster commands a second; fill: of the window.\n"
      "lost, rej.: per cent of the samples of the last minute. rev., age: of the model.\n"
      "error: free-run error over 5 s in the last minute, in units of that when the model was\n"
      "made.\n"
      "Example: telltale monitor --verdict WARN,ERROR --sort error");
  command.callback([arguments] { Monitor(*arguments); });
}

}  // namespace telltale
