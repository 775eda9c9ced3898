#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "telltale/client/bus/participant.hpp"
#include "telltale/client/bus/writer.hpp"
#include "telltale/client/cli/announce.hpp"
#include "telltale/client/cli/commands.hpp"
#include "telltale/client/cli/live_options.hpp"
#include "telltale/client/cli/load_boat.hpp"
#include "telltale/client/cli/number_range.hpp"
#include "telltale/client/cli/progress_line.hpp"
#include "telltale/client/cli/table.hpp"
#include "telltale/client/recording/file_contents.hpp"
#include "telltale/idl/codec/vehicle_file.hpp"
#include "telltale/idl/codec/wire/telemetry.hpp"
#include "telltale/idl/codec/wire/vehicle_announcement.hpp"

namespace telltale {
namespace {

using LoadClock = std::chrono::steady_clock;

// A boat sends what the bundled recording holds: 5 fixes, 50 headings and 10 commands a second.
constexpr double kTicksPerSecond = 50.0;  // times LoadArguments::times
constexpr int kTicksPerFix = 10;
constexpr int kTicksPerCommand = 5;

struct LoadArguments {
  int boats = 100;
  double duration_s = 60.0;
  double times = 1.0;
  double speed = 1.0;
  std::filesystem::path write_vehicles;
  bool announce = false;
  LiveOptions live;
};

std::string BoatName(int number) {
  std::string digits = std::to_string(number);
  return "load-" + std::string(digits.size() < 5 ? 5 - digits.size() : 0, '0') + digits;
}

Vehicle VehicleOfLoad(const std::string& vehicle_id) {
  Vehicle vehicle;
  vehicle.vehicle_id = vehicle_id;
  vehicle.propeller_separation_m = 0.7;
  vehicle.port = vehicle.starboard = {1500.0, 1900.0, 1100.0};
  return vehicle;
}

/// A boat, and the samples that it has sent.
class SendingBoat {
 public:
  SendingBoat(int number, int ticks_per_s)
      : vehicle_id_(BoatName(number)),
        ticks_per_s_(ticks_per_s),
        boat_(VehicleOfLoad(vehicle_id_), {37.0 + 1e-3 * number, -6.0},
              static_cast<std::uint64_t>(number), 1.0 / ticks_per_s) {}

  /// The samples of the tick that is due; returns how many there were.
  int Send(std::int64_t tick, Writer<telltale_wire_GnssFix>& gnss,
           Writer<telltale_wire_Heading>& heading, Writer<telltale_wire_Thrusters>& thrusters) {
    const double time_s = static_cast<double>(tick) / ticks_per_s_;
    boat_.Step();
    int sent = 1;
    heading.Write(
        Encode(Telemetry<HeadingSample>{vehicle_id_, ++headings_, boat_.Heading(time_s)}));
    if (tick % kTicksPerFix == 0) {
      gnss.Write(Encode(Telemetry<GnssFix>{vehicle_id_, ++fixes_, boat_.Fix(time_s)}));
      ++sent;
    }
    if (tick % kTicksPerCommand == 0) {
      thrusters.Write(
          Encode(Telemetry<ThrusterSample>{vehicle_id_, ++commands_, boat_.Commands(time_s)}));
      ++sent;
    }
    return sent;
  }

 private:
  std::string vehicle_id_;
  int ticks_per_s_;
  LoadBoat boat_;
  std::uint64_t fixes_ = 0;
  std::uint64_t headings_ = 0;
  std::uint64_t commands_ = 0;
};

void WriteVehicles(const LoadArguments& arguments) {
  std::filesystem::create_directories(arguments.write_vehicles);
  for (int i = 1; i <= arguments.boats; ++i) {
    const std::string name = BoatName(i);
    WriteFile(arguments.write_vehicles / (name + ".textproto"), PrintVehicle(VehicleOfLoad(name)));
  }
  std::cout << arguments.boats << " vehicle files are in " << arguments.write_vehicles.string()
            << "; name it as vehicle_folder of the daemon\n";
}

/// Announces the boats in the partition of all, as their telemetry goes out, and waits until
/// daemons serve them.
void AnnounceBoats(const LoadArguments& arguments, const Participant& participant,
                   Writer<telltale_wire_VehicleAnnouncement>& announcements) {
  constexpr auto kBusy = std::chrono::milliseconds(10);
  ProgressLine line;
  std::set<std::string> boats;
  for (int i = 1; i <= arguments.boats; ++i) {
    const Vehicle boat = VehicleOfLoad(BoatName(i));
    while (!announcements.Write(Encode(boat))) std::this_thread::sleep_for(kBusy);
    boats.insert(boat.vehicle_id);
  }
  announcements.Flush();
  RequireServed(participant, boats, arguments.live, [&](std::size_t unserved) {
    line.Update("announcing " + std::to_string(arguments.boats) + " boats",
                1.0 - static_cast<double>(unserved) / arguments.boats);
  });
}

void Load(const LoadArguments& arguments) {
  if (!arguments.write_vehicles.empty()) return WriteVehicles(arguments);
  BatchWrites();
  const Participant participant(arguments.live.domain);
  Writer<telltale_wire_GnssFix> gnss(participant);
  Writer<telltale_wire_Heading> heading(participant);
  Writer<telltale_wire_Thrusters> thrusters(participant);
  if (!WaitForMatch(participant, {gnss, heading, thrusters}, arguments.live.Timeout())) {
    throw std::runtime_error("nobody takes telemetry: " + NobodyThereAdvice(arguments.live.domain));
  }
  std::optional<Writer<telltale_wire_VehicleAnnouncement>> announcements;
  if (arguments.announce) {
    AnnounceBoats(arguments, participant, announcements.emplace(participant));
  }
  const auto ticks_per_s = static_cast<int>(std::lround(kTicksPerSecond * arguments.times));
  std::vector<SendingBoat> boats;
  for (int i = 1; i <= arguments.boats; ++i) boats.emplace_back(i, ticks_per_s);
  ProgressLine line;
  const auto begun = LoadClock::now();
  const std::int64_t ticks = std::llround(arguments.duration_s * arguments.speed * ticks_per_s);
  std::uint64_t sent = 0;
  double latest_s = 0.0;
  for (std::int64_t tick = 0; tick < ticks; ++tick) {
    const auto due =
        begun + std::chrono::duration_cast<LoadClock::duration>(std::chrono::duration<double>(
                    static_cast<double>(tick) / (ticks_per_s * arguments.speed)));
    std::this_thread::sleep_until(due);
    for (SendingBoat& boat : boats) {
      sent += static_cast<std::uint64_t>(boat.Send(tick, gnss, heading, thrusters));
    }
    gnss.Flush();
    heading.Flush();
    thrusters.Flush();
    latest_s = std::max(latest_s, std::chrono::duration<double>(LoadClock::now() - due).count());
    line.Update("sending " + std::to_string(arguments.boats) + " boats",
                static_cast<double>(tick + 1) / static_cast<double>(ticks));
  }
  const double took_s = std::chrono::duration<double>(LoadClock::now() - begun).count();
  std::cout << arguments.boats << " boats sent " << sent << " samples in " << Fixed(took_s, 1)
            << " s, " << Fixed(static_cast<double>(sent) / took_s, 0)
            << " a second; the latest was " << Fixed(latest_s, 2)
            << " s behind\ntelltale monitor shows what the daemon has lost\n";
}

}  // namespace

void AddLoad(CLI::App& telltale) {
  const auto arguments = std::make_shared<LoadArguments>();
  CLI::App& command = *telltale.add_subcommand(
      "load", "Sends the telemetry of many simulated boats, to see what a daemon can take");
  command.add_option("--boats", arguments->boats, "boats, load-00001 and on, 65 samples/s each")
      ->type_name("N")
      ->check(CLI::Range(1, 5000))
      ->capture_default_str();
  command.add_option("--duration", arguments->duration_s, "how long, in real time")
      ->type_name("S")
      ->check(NumberWithin(0.1, 86400.0))
      ->capture_default_str();
  command
      .add_option("--times", arguments->times,
                  "times as many samples of each boat, more as an overload, or less")
      ->type_name("X")
      ->check(NumberWithin(1.0 / kTicksPerSecond, 20.0))
      ->capture_default_str();
  command
      .add_option("--speed", arguments->speed,
                  "how fast the boats' clocks run, for a long time in a short one")
      ->type_name("X")
      ->check(NumberWithin(1.0, 1000.0))
      ->capture_default_str();
  command.add_flag("--announce", arguments->announce,
                   "the boats announce themselves, and the load begins once a daemon serves all");
  command
      .add_option("--write-vehicles", arguments->write_vehicles,
                  "only write the boats' vehicle files into this folder, for the daemon's "
                  "vehicle_folder")
      ->type_name("DIR")
      ->excludes("--announce");
  arguments->live.AddTo(command, 12.0, "give up when nobody takes telemetry for this long");
  command.footer(
      "Boats that no daemon knows count as UNKNOWN_VEHICLE alone: let a daemon have\n"
      "announced { admit: \"load-*\" }, or the files of --write-vehicles.\n"
      "Example: telltale load --boats 1000 --announce --duration 300");
  command.callback([arguments] { Load(*arguments); });
}

}  // namespace telltale
