#include "service/service_fixture.hpp"

#include <chrono>
#include <fstream>
#include <regex>
#include <stdexcept>
#include <thread>

#include "telltale/client/fleet/subscriber.hpp"
#include "telltale/client/recording/telemetry_log/telemetry_log.hpp"
#include "telltale/core/base/random.hpp"
#include "telltale/core/paper/yellowfish.hpp"
#include "telltale/core/simulation/sensors.hpp"
#include "telltale/core/simulation/simulator.hpp"
#include "telltale/idl/codec/vehicle_file.hpp"
#include "telltale/service/storage/stores.hpp"
#include "telltale/service/web/httplib.hpp"

namespace telltale {
namespace {

constexpr double kDurationS = 120.0;
constexpr double kHoldS = 2.0;
constexpr double kStepS = 0.02;

/// Uniform in [-1, 1].
double Draw(RandomEngine& random) {
  return static_cast<double>(random() >> 11) * 0x1p-52 - 1.0;
}

}  // namespace

Recording SimulatedRecording(const VesselModel& boat, double start_s, double duration_s,
                             std::uint64_t seed) {
  RandomEngine random(seed);
  std::vector<TimedCommand> commands;
  for (double time_s = start_s; time_s < start_s + duration_s; time_s += kHoldS) {
    const double port = Draw(random);
    commands.push_back({time_s, {port, Draw(random)}});
  }
  SensorOptions sensors;
  sensors.seed = seed;
  return Measure(Simulate(boat, {}, commands, start_s + duration_s, kStepS), YellowfishVehicle(),
                 sensors);
}

Recording SimulatedRecording() {
  return SimulatedRecording(YellowfishTwin(), 0.0, kDurationS, 20);
}

double SavedToS(Database& windows, const std::string& vehicle_id) {
  double saved_to_s = 0.0;
  windows.Query("SELECT COALESCE(MAX(last_s), 0) AS value FROM chunks WHERE vehicle_id = $1",
                {vehicle_id}, [&](const Row& row) { saved_to_s = row.Real("value"); });
  return saved_to_s;
}

std::size_t SizeOf(const Recording& recording) {
  return recording.gnss.size() + recording.heading.size() + recording.thrusters.size();
}

ServiceTest::ServiceTest(Engine engine, bool is_tagged) : domain_(is_tagged), engine_(engine) {
  Vehicle vehicle = YellowfishVehicle();
  vehicle.vehicle_id = kVehicleId;
  folder_.Write("vehicle.textproto", PrintVehicle(vehicle));
  // The structure that takes the least time: most tests are about the service.
  ConfigureIdentification("bootstrap_replicates: 100 structure: \"static\"");
}

void ServiceTest::ConfigureIdentification(const std::string& settings,
                                          const std::vector<std::string>& vehicle_files,
                                          const std::string& window_settings) {
  std::string files;
  for (const std::string& file : vehicle_files) files += "vehicle_files: \"" + file + "\"\n";
  config_file_ =
      folder_.Write("daemon.textproto", "domain: " + std::to_string(domain_.id()) + "\n" + files +
                                            StorageLines() + "identification { " + settings +
                                            " }\n"
                                            "quality_period_s: 0.1\nwindow { save_period_s: 0.2 " +
                                            window_settings + " }\n");
}

void ServiceTest::Configure(const std::string& more) const {
  std::ofstream(config_file_, std::ios::app) << more;
}

std::string ServiceTest::StorageLines() const {
  return "state_directory: \"" + (folder_.Path() / "state").string() + "\"\ndatabase: \"" +
         engine_.Address() + "\"\n";
}

std::unique_ptr<Process> ServiceTest::StartDaemon(int vehicles) const {
  auto daemon =
      std::make_unique<Process>(std::vector<std::string>{TELLTALED, "--config", config_file_});
  EXPECT_TRUE(daemon->WaitForOutput("serving " + std::to_string(vehicles) + " vehicles"))
      << daemon->output();
  return daemon;
}

std::optional<double> ServiceTest::Metric(const Process& daemon, const std::string& name) {
  std::smatch page;
  const std::string log = daemon.output();
  if (!std::regex_search(log, page, std::regex("the page is at (http://127[.0-9]*:[0-9]+)/"))) {
    throw std::runtime_error("the daemon has no page: " + log);
  }
  const auto answer = httplib::Client(page[1]).Get("/metrics");
  if (!answer) throw std::runtime_error("no answer: " + httplib::to_string(answer.error()));
  const std::size_t line = ('\n' + answer->body).find('\n' + name + ' ');
  if (line == std::string::npos) return std::nullopt;
  return std::stod(answer->body.substr(line + name.size() + 1));
}

bool ServiceTest::AwaitMetric(const Process& daemon, const std::string& name, double value) {
  constexpr auto kLookAgain = std::chrono::milliseconds(100);
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (Metric(daemon, name) != value) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(kLookAgain);
  }
  return true;
}

bool ServiceTest::AwaitSavedWindow(const std::string& vehicle_id) const {
  const auto windows = Storage().Open(WindowsSchema());
  return AwaitQuality(vehicle_id,
                      [&](const Quality& quality) {
                        return quality.window_s > 1.0 &&
                               SavedToS(*windows, vehicle_id) >= quality.window_s - 0.5;
                      })
      .has_value();
}

std::unique_ptr<Process> ServiceTest::Start(const std::vector<std::string>& arguments) const {
  std::vector<std::string> command{TELLTALE};
  command.insert(command.end(), arguments.begin(), arguments.end());
  command.push_back("--domain");
  command.push_back(std::to_string(domain_.id()));
  return std::make_unique<Process>(command);
}

void ServiceTest::Run(const std::vector<std::string>& arguments) const {
  const auto command = Start(arguments);
  if (command->Wait() != 0) {
    throw std::runtime_error(arguments.front() + " failed: " + command->output());
  }
}

void ServiceTest::ReplaySimulation() const {
  Replay(SimulatedRecording());
}

void ServiceTest::Replay(const Recording& recording) const {
  const auto log = folder_.Path() / "log";
  WriteTelemetryLog(log, recording);
  Run({"replay", "--log", log, "--vehicle-id", kVehicleId, "--speed", "60"});
}

IdentifyRequest ServiceTest::Request(const std::string& correlation_id) const {
  IdentifyRequest request;
  request.correlation_id = correlation_id;
  request.vehicle_id = kVehicleId;
  return request;
}

std::optional<Quality> ServiceTest::AwaitQuality(
    const std::string& vehicle_id, const std::function<bool(const Quality&)>& as_expected) const {
  const Participant participant(domain_.id());
  std::optional<Quality> found;
  QualitySubscriber qualities(
      participant,
      [&](const Quality& quality) {
        if (quality.vehicle_id == vehicle_id && as_expected(quality)) found = quality;
      },
      [](const CodecError& error) { ADD_FAILURE() << error.Message(); });
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!found && std::chrono::steady_clock::now() < deadline) {
    qualities.Wait(std::chrono::seconds(1));
  }
  return found;
}

std::uint64_t CountOf(const Quality& quality, const std::string& channel,
                      const std::string& reason) {
  for (const RejectEntry& entry : quality.rejected) {
    if (entry.channel == channel && entry.reason == reason) return entry.count;
  }
  return 0;
}

}  // namespace telltale
