#include <chrono>
#include <iostream>
#include <map>
#include <memory>
#include <utility>

#include <unistd.h>

#include "telltale/client/bus/participant.hpp"
#include "telltale/client/cli/commands.hpp"
#include "telltale/client/cli/live_options.hpp"
#include "telltale/client/cli/quality_table.hpp"
#include "telltale/client/fleet/subscriber.hpp"

namespace telltale {
namespace {

using Clock = std::chrono::steady_clock;

struct MonitorArguments {
  bool once = false;
  std::size_t count = 0;
  LiveOptions live;
};

/// The newest quality of every vehicle. A daemon ends each round with what names no vehicle.
class Rounds {
 public:
  void Take(const Quality& quality) {
    fleet_[quality.vehicle_id] = quality;
    if (quality.vehicle_id == kUnattributed && !std::exchange(joined_midway_, false)) ++complete_;
  }
  std::size_t complete() const { return complete_; }
  const std::map<std::string, Quality>& fleet() const { return fleet_; }

 private:
  std::map<std::string, Quality> fleet_;
  bool joined_midway_ = true;
  std::size_t complete_ = 0;
};

void Monitor(const MonitorArguments& arguments) {
  const Participant participant(arguments.live.domain);
  Rounds rounds;
  QualitySubscriber qualities(
      participant, [&](const Quality& quality) { rounds.Take(quality); },
      [](const CodecError& error) {
        std::cerr << "telltale: a report is rejected: " << error.Message() << '\n';
      });

  const std::size_t wanted = arguments.once ? 1 : arguments.count;
  const bool redraw = wanted != 1 && isatty(STDOUT_FILENO) == 1;
  std::size_t shown = 0;
  auto deadline = Clock::now() + arguments.live.Timeout();
  while (wanted == 0 || shown < wanted) {
    if (Clock::now() >= deadline) {
      throw std::runtime_error("no reports of a daemon: " +
                               NobodyThereAdvice(arguments.live.domain));
    }
    qualities.Wait(deadline - Clock::now());
    if (rounds.complete() == shown) continue;
    shown = rounds.complete();
    deadline = Clock::now() + arguments.live.Timeout();
    std::cout << (redraw ? "\x1b[H\x1b[2J" : "") << QualityTable(rounds.fleet()) << '\n'
              << std::flush;
  }
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
  arguments->live.AddTo(command, 10.0, "give up when no report comes for this long");
  command.footer(
      "error: free-run error over 5 s in the last minute, in units of that when the model was\n"
      "made. drift: its running change. lost: gaps in the sequence numbers.\n"
      "~f:d: live one-step estimate of surge f:d, forward thrust, linear (m/s^2), with its\n"
      "standard error; it is indicative and has no bounds.\n"
      "Example: telltale monitor --count 1");
  command.callback([arguments] { Monitor(*arguments); });
}

}  // namespace telltale
