#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <limits>
#include <memory>
#include <thread>

#include "telltale/client/bus/participant.hpp"
#include "telltale/client/bus/writer.hpp"
#include "telltale/client/cli/commands.hpp"
#include "telltale/client/cli/exit_codes.hpp"
#include "telltale/client/cli/input_options.hpp"
#include "telltale/client/cli/live_options.hpp"
#include "telltale/client/cli/progress_line.hpp"
#include "telltale/client/cli/table.hpp"
#include "telltale/client/fleet/telemetry_publisher.hpp"
#include "telltale/client/recording/load_recording.hpp"

namespace telltale {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

// Samples leave in bursts: few packets. Receivers hold 64 samples of a vehicle's channel until they
// get to read them, so a burst is kept well below that, and the next gives them time.
constexpr std::size_t kBurstSamples = 40;
constexpr auto kBurstSpacing = std::chrono::milliseconds(2);

// A recording may have been switched off for hours; nobody wants to wait that long.
constexpr double kLongestSilenceS = 60.0;

struct ReplayArguments {
  std::filesystem::path log;
  DataFlashOptions dataflash;
  std::string vehicle_id;
  double speed = 1.0;
  LiveOptions live;
};

/// When samples are due, in seconds of the recording since its beginning: never backwards, and no
/// silence longer than kLongestSilenceS.
class Schedule {
 public:
  double DueTime(double time_s) {
    if (!(time_s > newest_s_)) return due_s_;  // a wrong time, NaN included, is due at once
    due_s_ += begun_ ? std::min(time_s - newest_s_, kLongestSilenceS) : 0.0;
    newest_s_ = time_s;
    begun_ = true;
    return due_s_;
  }

 private:
  bool begun_ = false;
  double newest_s_ = -std::numeric_limits<double>::infinity();
  double due_s_ = 0.0;
};

/// Publishes the samples at their times, or as fast as receivers can be trusted to follow; returns
/// how many seconds of recording went by.
double Publish(const std::vector<RawSample>& samples, double speed, TelemetryPublisher& publisher) {
  ProgressLine line;
  Schedule schedule;
  double due_s = 0.0;
  const auto start = Clock::now();
  auto burst_begin = start;
  std::size_t burst = 0;
  for (const RawSample& sample : samples) {
    due_s = schedule.DueTime(TimeOf(sample));
    const auto due = start + std::chrono::ceil<Clock::duration>(Seconds(due_s / speed));
    if (burst == kBurstSamples || due > burst_begin + kBurstSpacing) {
      publisher.Flush();
      line.Update("replaying",
                  static_cast<double>(publisher.Published()) / static_cast<double>(samples.size()));
      std::this_thread::sleep_until(std::max(due, burst_begin + kBurstSpacing));
      burst_begin = Clock::now();
      burst = 0;
    }
    std::visit([&](const auto& s) { publisher.Publish(s); }, sample);
    ++burst;
  }
  publisher.Flush();
  return due_s;
}

void Replay(const ReplayArguments& arguments) {
  const RawLog log = OrThrow(ReadLog(arguments.log, arguments.dataflash));
  const Participant participant(arguments.live.domain);
  BatchWrites();
  TelemetryPublisher publisher(participant, arguments.vehicle_id);
  if (!publisher.WaitForReaders(arguments.live.Timeout())) {
    throw std::runtime_error("nobody takes telemetry on domain " +
                             std::to_string(arguments.live.domain) + ": " +
                             NobodyThereAdvice(arguments.live.domain));
  }
  const auto start = Clock::now();
  const double recorded_s = Publish(log.samples, arguments.speed, publisher);
  const double elapsed_s = Seconds(Clock::now() - start).count();
  std::cout << "replayed " << publisher.Published() << " samples as " << arguments.vehicle_id
            << ": " << Fixed(recorded_s, 1) << " s of recording in " << Fixed(elapsed_s, 1)
            << " s, " << Fixed(static_cast<double>(publisher.Published()) / elapsed_s, 0)
            << " samples/s\n";
}

}  // namespace

void AddReplay(CLI::App& telltale) {
  const auto arguments = std::make_shared<ReplayArguments>();
  CLI::App& command =
      *telltale.add_subcommand("replay", "Publishes a recording as a vehicle's live telemetry");
  AddLog(command, arguments->log, arguments->dataflash);
  AddVehicleId(command, arguments->vehicle_id)->required();
  command.add_option("--speed", arguments->speed, "times as fast as it was recorded")
      ->type_name("X")
      ->check(CLI::Range(1e-3, 1e6))
      ->capture_default_str();
  arguments->live.AddTo(command, 10.0, "how long to wait for somebody to receive it");
  command.footer(
      "Samples go out as recorded, wrong ones too: the receiver judges them. Silences longer than "
      "a\n"
      "minute are cut to a minute.\n"
      "Example: telltale replay --log run1 --vehicle-id boat-1 --speed 50");
  command.callback([arguments] { Replay(*arguments); });
}

}  // namespace telltale
