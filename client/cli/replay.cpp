#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "telltale/client/bus/participant.hpp"
#include "telltale/client/bus/writer.hpp"
#include "telltale/client/cli/announce.hpp"
#include "telltale/client/cli/commands.hpp"
#include "telltale/client/cli/input_options.hpp"
#include "telltale/client/cli/live_options.hpp"
#include "telltale/client/cli/number_range.hpp"
#include "telltale/client/cli/progress_line.hpp"
#include "telltale/client/cli/table.hpp"
#include "telltale/client/fleet/receipts.hpp"
#include "telltale/client/fleet/telemetry_publisher.hpp"
#include "telltale/client/recording/due_times.hpp"
#include "telltale/client/recording/load_recording.hpp"
#include "telltale/client/workbench/errors.hpp"
#include "telltale/client/workbench/files.hpp"

namespace telltale {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

// A receiver holds 64 samples of a vehicle's channel until it takes them, and reports the count of
// what it took every 32 samples. No more than that many are ever under way, so that a busy receiver
// loses none.
constexpr std::uint64_t kMostUnderWay = 60;

// Samples leave in bursts, which make few packets. Where nobody reports, bursts are spaced in time.
constexpr std::size_t kBurstSamples = 20;
constexpr auto kBurstSpacing = std::chrono::milliseconds(2);

// A receiver that accounts for nothing for so long has lost what is under way.
constexpr auto kReceiptPatience = std::chrono::seconds(10);

struct ReplayArguments {
  std::filesystem::path log;
  SourceOptions options;
  std::string vehicle_id;                ///< empty: that of the vehicle to announce
  std::filesystem::path announced_file;  ///< empty: it does not announce itself
  double speed = 1.0;
  LiveOptions live;
};

/// Keeps the number of samples under way within what a receiver holds.
class Pacing {
 public:
  Pacing(const Participant& participant, const std::string& vehicle_id)
      : receipts_(participant, vehicle_id), reported_(receipts_.Begin(kReceiptPatience)) {}

  /// Whether a daemon reports how many samples it took.
  bool Reported() const { return reported_; }

  /// Waits until the next burst after `published` samples may leave.
  void WaitForRoom(std::uint64_t published) {
    const std::uint64_t with_burst = published + kBurstSamples;
    if (with_burst > kMostUnderWay) WaitUntilTaken(with_burst - kMostUnderWay, published);
  }

  /// Waits until all `published` samples are accounted for.
  void Finish(std::uint64_t published) { WaitUntilTaken(published, published); }

  std::uint64_t Lost() const { return receipts_.Lost(); }
  std::uint64_t Shed() const { return receipts_.Shed(); }

 private:
  void WaitUntilTaken(std::uint64_t count, std::uint64_t published) {
    if (!reported_ || receipts_.WaitFor(count, kReceiptPatience)) return;
    const std::uint64_t accounted = receipts_.Accounted();
    reported_ = accounted != accounted_at_write_off_;  // else the daemon is gone
    receipts_.WriteOff(published - std::min(published, accounted));
    accounted_at_write_off_ = receipts_.Accounted();
  }

  Receipts receipts_;
  bool reported_;
  std::uint64_t accounted_at_write_off_ = 0;
};

/// Publishes the samples at their times, or as fast as the receiver follows; returns how many
/// seconds of recording went by.
double Publish(const std::vector<RawSample>& samples, double speed, TelemetryPublisher& publisher,
               Pacing& pacing) {
  ProgressLine line;
  const std::vector<double> due_s = DueTimes(samples);
  const auto start = Clock::now();
  auto burst_begin = start;
  std::size_t burst = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto due = start + std::chrono::ceil<Clock::duration>(Seconds(due_s[i] / speed));
    if (burst == kBurstSamples || due > burst_begin + kBurstSpacing) {
      publisher.Flush();
      line.Update("replaying",
                  static_cast<double>(publisher.Published()) / static_cast<double>(samples.size()));
      pacing.WaitForRoom(publisher.Published());
      const auto spaced = pacing.Reported() ? due : std::max(due, burst_begin + kBurstSpacing);
      std::this_thread::sleep_until(spaced);
      burst_begin = Clock::now();
      burst = 0;
    }
    std::visit([&](const auto& s) { publisher.Publish(s); }, samples[i]);
    ++burst;
  }
  publisher.Flush();
  pacing.Finish(publisher.Published());
  return due_s.empty() ? 0.0 : due_s.back();
}

std::string OutcomeText(const Pacing& pacing) {
  if (!pacing.Reported()) return "; no daemon reports on this vehicle";
  std::string text = ", all received";
  if (pacing.Lost() > 0) {
    text = ", " + Counted(pacing.Lost(), "sample", "samples") + " lost on the way";
  }
  if (pacing.Shed() > 0) {
    text += ", " + Counted(pacing.Shed(), "sample", "samples") +
            " shed by the daemon, which was sent more than it takes in";
  }
  return text;
}

std::vector<Vehicle> AnnouncedBy(const ReplayArguments& arguments) {
  if (arguments.announced_file.empty()) return {};
  Vehicle vehicle = LoadVehicle(arguments.announced_file);
  if (arguments.vehicle_id.empty() || arguments.vehicle_id == vehicle.vehicle_id) {
    return {std::move(vehicle)};
  }
  throw UsageError("--announce: " + arguments.announced_file.string() + " is of " +
                   vehicle.vehicle_id + ", and --vehicle-id is " + arguments.vehicle_id +
                   ": they must be the same");
}

void Replay(const ReplayArguments& arguments) {
  const std::vector<Vehicle> announced = AnnouncedBy(arguments);
  const std::string vehicle_id =
      announced.empty() ? arguments.vehicle_id : announced.front().vehicle_id;
  const RawLog log = ReadShown(arguments.log, arguments.options);
  if (auto refusal = LacksChannel(arguments.log, log)) throw RefusedError(*std::move(refusal));
  const Participant participant(arguments.live.domain);
  BatchWrites();
  const auto announcers = Announce(participant, announced);
  TelemetryPublisher publisher(participant, vehicle_id);
  if (!publisher.WaitForReaders(arguments.live.Timeout())) {
    throw std::runtime_error("nobody takes telemetry on domain " +
                             std::to_string(arguments.live.domain) + ": " +
                             NobodyThereAdvice(arguments.live.domain));
  }
  if (!announced.empty()) RequireServed(participant, {vehicle_id}, arguments.live);
  Pacing pacing(participant, vehicle_id);
  const double recorded_s =
      Publish(InOrderOfTime(log.channels), arguments.speed, publisher, pacing);
  std::cout << "replayed " << publisher.Published() << " samples as " << vehicle_id << ", "
            << Fixed(recorded_s, 1) << " s of recording" << OutcomeText(pacing) << '\n';
}

}  // namespace

void AddReplay(CLI::App& telltale) {
  const auto arguments = std::make_shared<ReplayArguments>();
  CLI::App& command =
      *telltale.add_subcommand("replay", "Publishes a recording as a vehicle's live telemetry");
  AddLog(command, arguments->log, arguments->options);
  CLI::App& whose = *command.add_option_group("whose", "the boat");
  AddVehicleId(whose, arguments->vehicle_id);
  whose
      .add_option("--announce", arguments->announced_file,
                  "the boat announces itself with this vehicle file, and the replay begins once a "
                  "daemon serves it")
      ->type_name("FILE")
      ->check(CLI::ExistingFile.description(""));
  whose.require_option(1, 2);
  command.add_option("--speed", arguments->speed, "times as fast as it was recorded")
      ->type_name("X")
      ->check(NumberWithin(1e-3, 1e6))
      ->capture_default_str();
  arguments->live.AddTo(command, 10.0, "how long to wait for somebody to receive it");
  command.footer(
      "Samples go out as recorded, wrong ones too: the receiver checks them. Silences longer than\n"
      "a minute are cut to a minute.\n"
      "Examples: telltale replay --log run1 --vehicle-id boat-1 --speed 50\n"
      "          telltale replay --log run1 --announce boat-1.textproto");
  command.callback([arguments] { Replay(*arguments); });
}

}  // namespace telltale
