#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "service/storage_fixture.hpp"
#include "support/loopback_domain.hpp"
#include "support/process.hpp"
#include "support/temporary_folder.hpp"
#include "telltale/client/bus/participant.hpp"
#include "telltale/client/fleet/identification_client.hpp"
#include "telltale/core/data/samples.hpp"
#include "telltale/core/vessel/vessel_model.hpp"
#include "telltale/idl/codec/messages/exchange.hpp"
#include "telltale/idl/codec/messages/quality.hpp"

namespace telltale {

/// A boat under random steps in all four regions, from `start_s` of its clock.
Recording SimulatedRecording(const VesselModel& boat, double start_s, double duration_s,
                             std::uint64_t seed);

/// Two minutes of the simulated Yellowfish.
Recording SimulatedRecording();

/// The time of the newest sample of a vehicle that the store of windows holds; 0: it holds none.
double SavedToS(Database& windows, const std::string& vehicle_id);

std::size_t SizeOf(const Recording& recording);

/// Real programs on a domain and in a folder of the test's own.
class ServiceTest : public ::testing::Test {
 protected:
  static constexpr const char* kVehicleId = "yellowfish";

  /// `is_tagged`: as LoopbackDomain has it.
  explicit ServiceTest(Engine engine = Engine::kSqlite, bool is_tagged = true);

  /// Writes the daemon's configuration, with these settings of its identification, and more of its
  /// windows.
  void ConfigureIdentification(
      const std::string& settings,
      const std::vector<std::string>& vehicle_files = {"vehicle.textproto"},
      const std::string& window_settings = "");

  /// Lets the daemon's configuration have this too.
  void Configure(const std::string& more) const;

  /// telltaled, serving so many vehicles.
  std::unique_ptr<Process> StartDaemon(int vehicles = 1) const;

  /// The value of a metric of a daemon with a web server, as `name{labels}`; nothing where there is
  /// none.
  static std::optional<double> Metric(const Process& daemon, const std::string& name);

  /// Waits until a metric has this value. False where that takes a minute.
  static bool AwaitMetric(const Process& daemon, const std::string& name, double value);

  /// Waits until the newest sample of the window is on disk. False where that takes a minute.
  /// Assumes a recording whose clock starts at 0.
  bool AwaitSavedWindow(const std::string& vehicle_id = kVehicleId) const;

  /// telltale with these arguments on this test's domain.
  std::unique_ptr<Process> Start(const std::vector<std::string>& arguments) const;

  /// telltale with these arguments, to the end. Throws what it wrote where it exits with another
  /// code than 0.
  void Run(const std::vector<std::string>& arguments) const;

  /// Writes the simulated recording as a log and replays it to the end.
  void ReplaySimulation() const;

  /// The same with any recording.
  void Replay(const Recording& recording) const;

  IdentifyRequest Request(const std::string& correlation_id) const;

  /// The first report on `vehicle_id` that is `as_expected`; empty when none is within a minute.
  std::optional<Quality> AwaitQuality(const std::string& vehicle_id,
                                      const std::function<bool(const Quality&)>& as_expected) const;

  /// Lines of a configuration: where the daemon keeps what outlives it.
  std::string StorageLines() const;
  telltale::Storage Storage() const { return engine_.StorageIn(folder_.Path() / "state"); }

  LoopbackDomain domain_;
  EngineStorage engine_;
  TemporaryFolder folder_;
  std::filesystem::path config_file_;
};

/// How often this was set aside for that reason.
std::uint64_t CountOf(const Quality& quality, const std::string& channel,
                      const std::string& reason);

}  // namespace telltale
