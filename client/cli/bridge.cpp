#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <iostream>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "telltale/client/bridge/mavlink_bridge.hpp"
#include "telltale/client/bridge/mavlink_link.hpp"
#include "telltale/client/bus/participant.hpp"
#include "telltale/client/cli/commands.hpp"
#include "telltale/client/cli/live_options.hpp"
#include "telltale/client/cli/number_range.hpp"
#include "telltale/client/cli/progress_line.hpp"
#include "telltale/client/cli/table.hpp"
#include "telltale/client/workbench/errors.hpp"
#include "telltale/idl/codec/vehicle_file.hpp"

namespace telltale {
namespace {

constexpr int kLineEachSeconds = 2;

struct BridgeArguments {
  MavlinkAddress address;
  std::vector<int> systems;
  MavlinkBridgeOptions options;
  std::uint32_t domain = 0;
};

/// UTC in seconds, by a clock that is set once and never goes back.
class UtcClock {
 public:
  double Now() const {
    const std::chrono::duration<double> since = std::chrono::steady_clock::now() - steady_;
    return begun_s_ + since.count();
  }

 private:
  std::chrono::steady_clock::time_point steady_ = std::chrono::steady_clock::now();
  double begun_s_ =
      std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
};

template <class Counts>
std::uint64_t Total(const Counts& counts) {
  return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
}

/// On a terminal: the rates of each vehicle, drawn anew in place every two seconds.
class RatesLine {
 public:
  void EachSecond(const std::vector<MavlinkVehicleCounts>& vehicles) {
    if (!on_terminal_ || ++seconds_ % kLineEachSeconds != 0) return;
    std::cerr << kClearLine << (vehicles.empty() ? "no vehicle is heard yet" : "");
    for (std::size_t i = 0; i < vehicles.size(); ++i) {
      std::cerr << (i > 0 ? "  |  " : "") << TextOf(vehicles[i]);
    }
    std::cerr << std::flush;
    before_ = vehicles;
  }

  void Erase() const {
    if (on_terminal_) std::cerr << kClearLine;
  }

 private:
  std::string TextOf(const MavlinkVehicleCounts& now) const {
    const auto found = std::find_if(before_.begin(), before_.end(),
                                    [&](const auto& then) { return then.system == now.system; });
    std::string text = now.vehicle_id;
    for (const Channel channel : kChannels) {
      const auto at = static_cast<std::size_t>(channel);
      const std::uint64_t then = found == before_.end() ? 0 : found->published[at];
      const double rate_hz = static_cast<double>(now.published[at] - then) / kLineEachSeconds;
      text += ' ' + std::string(Name(channel)) + ' ' + Fixed(rate_hz, 1) + " Hz";
    }
    return text + ", " + std::to_string(now.lost_frames) + " lost, " +
           std::to_string(Total(now.rejected)) + " rejected";
  }

  bool on_terminal_ = isatty(STDERR_FILENO) != 0;
  int seconds_ = 0;
  std::vector<MavlinkVehicleCounts> before_;
};

void PrintSummary(const MavlinkBridge& bridge) {
  Table table({{"vehicle"},
               {"system", Align::kRight},
               {"positions", Align::kRight},
               {"headings", Align::kRight},
               {"commands", Align::kRight},
               {"lost frames", Align::kRight},
               {"rejected", Align::kRight}});
  std::string notes;
  const auto note = [&](const std::string& whose, std::uint64_t count, std::string_view what) {
    if (count > 0) notes += whose + std::to_string(count) + ' ' + std::string(what) + '\n';
  };
  for (const MavlinkVehicleCounts& one : bridge.Counts()) {
    table.AddRow({one.vehicle_id, std::to_string(one.system), std::to_string(one.published[0]),
                  std::to_string(one.published[1]), std::to_string(one.published[2]),
                  std::to_string(one.lost_frames), std::to_string(Total(one.rejected))});
    for (const MavlinkReject reason : kMavlinkRejects) {
      note(one.vehicle_id + ": ", one.rejected[static_cast<std::size_t>(reason)], Name(reason));
    }
    note(one.vehicle_id + ": ", one.other_sender, "frames of another sender with its system id");
  }
  note("", bridge.Damage().corrupt_frames, "messages with a wrong checksum");
  note("", bridge.Damage().skipped_bytes + bridge.Damage().truncated_bytes,
       "bytes that are no MAVLink");
  std::cout << table.Render() << notes;
}

void RequireVehicleIds(const MavlinkBridgeOptions& options) {
  const std::string& pattern = options.vehicle_id;
  const bool one_for_each = pattern.find(kSystemPlaceholder) != std::string::npos;
  if (!one_for_each && options.systems.size() != 1) {
    throw UsageError("--vehicle-id: " + pattern + " names one vehicle: say which by one " +
                     "--system-id, or let it contain " + kSystemPlaceholder);
  }
  if (!IsVehicleId(VehicleIdOf(pattern, 255))) {
    throw UsageError("--vehicle-id: " + pattern + " must make " + std::string(kVehicleIdAllowed) +
                     " once " + kSystemPlaceholder + " is replaced by the system id");
  }
}

void Bridge(BridgeArguments arguments) {
  arguments.options.systems = {arguments.systems.begin(), arguments.systems.end()};
  RequireVehicleIds(arguments.options);
  const UtcClock clock;
  RatesLine rates;
  const auto report = [&](const std::string& what) {
    rates.Erase();
    std::cerr << what << std::endl;
  };
  MavlinkLink link(arguments.address);
  const Participant participant(arguments.domain);
  MavlinkBridge bridge(
      participant, arguments.options,
      [&](const std::string& sender, auto bytes) { link.Send(sender, bytes); }, report);
  report("waiting for MAVLink");
  link.Run({[&](const std::string& sender, auto bytes, bool whole) {
              bridge.Receive(sender, bytes, whole, clock.Now());
            },
            [&] {
              bridge.EachSecond(clock.Now());
              rates.EachSecond(bridge.Counts());
            },
            report});
  rates.Erase();
  PrintSummary(bridge);
}

}  // namespace

void AddBridge(CLI::App& telltale) {
  const auto arguments = std::make_shared<BridgeArguments>();
  MavlinkBridgeOptions& options = arguments->options;
  CLI::App& command = *telltale.add_subcommand(
      "bridge", "Publishes the MAVLink streams of running autopilots as telemetry");
  command
      .add_option_function<std::string>(
          "--mavlink",
          [arguments](const std::string& text) { arguments->address = *ParseMavlinkAddress(text); },
          "where the stream comes from: udp:HOST:PORT is listened on, tcp:HOST:PORT is connected "
          "to, serial:DEVICE:BAUD is opened")
      ->type_name("ADDRESS")
      ->check(CLI::Validator(
          [](const std::string& text) {
            const auto address = ParseMavlinkAddress(text);
            return address ? std::string() : address.error();
          },
          ""))
      ->required();
  command
      .add_option("--vehicle-id", options.vehicle_id,
                  "the vehicles' ids; {system} stands for the system id of MAVLink")
      ->type_name("PATTERN")
      ->capture_default_str();
  command
      .add_option("--system-id", arguments->systems,
                  "take these vehicles alone, [1, 255] (default: all)")
      ->type_name("N")
      ->check(CLI::Range(1, 255).description(""));
  const auto channel = [&](const std::string& name, std::optional<int>& value,
                           const std::string& help) {
    command.add_option(name, value, help)
        ->type_name("N")
        ->check(CLI::Range(1, kMavlinkOutputs).description(""));
  };
  channel("--port-channel", options.port_channel,
          "the output that drives the port thruster, [1, 16] (default: the one whose "
          "SERVOn_FUNCTION is 73)");
  channel("--starboard-channel", options.starboard_channel,
          "the same for starboard (default: SERVOn_FUNCTION 74)");
  command
      .add_option("--rate", options.rate_hz, "how often to ask for each message, in Hz, [0.1, 100]")
      ->type_name("HZ")
      ->check(NumberWithin(0.1, 100.0))
      ->capture_default_str();
  command.add_flag("--listen-only", options.listen_only, "send nothing: no heartbeat, no requests");
  command.add_option("--domain", arguments->domain, "DDS domain")
      ->envname("TELLTALE_DOMAIN")
      ->check(CLI::Range(0u, kHighestDomain))
      ->capture_default_str();
  command.footer(
      "Runs until Ctrl-C or SIGTERM, then says what went through. Lost links are opened again.\n"
      "Example: telltale bridge --mavlink udp:0.0.0.0:14550 --vehicle-id boat-{system}");
  command.callback([arguments] { Bridge(*arguments); });
}

}  // namespace telltale
