#include <signal.h>

#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "service/service_fixture.hpp"
#include "support/stable_boat.hpp"
#include "telltale/core/paper/yellowfish.hpp"
#include "telltale/idl/codec/vehicle_file.hpp"

namespace telltale {
namespace {

using ::testing::HasSubstr;

/// What an operator does to a daemon: boats that come and go, backups.
class Upkeep : public ServiceTest {
 protected:
  Upkeep() {
    std::filesystem::create_directory(folder_.Path() / "boats");
    WriteBoat(kVehicleId, 0.57);
    config_file_ =
        folder_.Write("upkeep.textproto",
                      "domain: " + std::to_string(domain_.id()) +
                          "\nvehicle_folder: \"boats\"\nstate_directory: \"" + State().string() +
                          "\"\nidentification { bootstrap_replicates: 100 structure: \"static\" }\n"
                          "quality_period_s: 0.1\nwindow { save_period_s: 0.2 }\n");
  }

  std::filesystem::path State() const { return folder_.Path() / "state"; }

  void WriteBoat(const std::string& id, double separation_m) const {
    Vehicle vehicle = YellowfishVehicle();
    vehicle.vehicle_id = id;
    vehicle.propeller_separation_m = separation_m;
    folder_.Write("boats/" + id + ".textproto", PrintVehicle(vehicle));
  }

  Process Upkeeper(const std::string& option, const std::filesystem::path& folder) const {
    return Process({TELLTALED, "--config", config_file_, option, folder});
  }
};

TEST_F(Upkeep, ServesBoatsThatComeAndGo) {
  const auto daemon = StartDaemon();
  ReplaySimulation();
  WriteBoat("second", 0.57);
  WriteBoat(kVehicleId, 0.60);
  daemon->Signal(SIGHUP);
  EXPECT_TRUE(daemon->WaitForOutput("serving 2 vehicles: 1 added, 1 changed, 0 no longer served"));
  // The boat whose file has changed keeps its samples and its counts.
  const auto quality = AwaitQuality(kVehicleId, [](const Quality&) { return true; });
  ASSERT_TRUE(quality);
  EXPECT_GT(quality->window_s, 100.0);
  EXPECT_GT(quality->accepted, 1000u);
  EXPECT_TRUE(AwaitQuality("second", [](const Quality&) { return true; }));

  std::filesystem::remove(folder_.Path() / "boats" / (std::string(kVehicleId) + ".textproto"));
  daemon->Signal(SIGHUP);
  EXPECT_TRUE(daemon->WaitForOutput("serving 1 vehicles: 0 added, 0 changed, 1 no longer served"));
  const auto identify = Start({"identify", "--vehicle-id", kVehicleId});
  EXPECT_EQ(identify->Wait(), 1);
  EXPECT_THAT(identify->output(), HasSubstr("is not served here; served: second"));
}

TEST_F(Upkeep, KeepsItsBoatsWhereTheConfigurationIsWrong) {
  const auto daemon = StartDaemon();
  folder_.Write("boats/wrong.textproto", "vehicle_id: \"two words\"\n");
  daemon->Signal(SIGHUP);
  EXPECT_TRUE(daemon->WaitForOutput("the vehicles are not reloaded"));
  EXPECT_THAT(daemon->output(), HasSubstr("wrong.textproto"));
  EXPECT_EQ(Start({"list"})->Wait(), 0);
}

TEST_F(Upkeep, LeavesTheBackupsOfADatabaseToItsServer) {
  config_file_ = folder_.Write("server.textproto", "database: \"postgresql:///telltale\"\n");
  Process back_up = Upkeeper("--backup", folder_.Path() / "backup");
  EXPECT_EQ(back_up.Wait(), 1);
  EXPECT_THAT(back_up.output(), HasSubstr("pg_dump"));
}

TEST_F(Upkeep, RestoresABackupThatWasMadeWhileItRan) {
  auto daemon = StartDaemon();
  Replay(SimulatedRecording(testing::StableBoat(), 0.0, 300.0, 4));
  Run({"identify", "--vehicle-id", kVehicleId});
  ASSERT_TRUE(AwaitSavedWindow());
  const auto backup = folder_.Path() / "backup";
  Process back_up = Upkeeper("--backup", backup);
  ASSERT_EQ(back_up.Wait(), 0) << back_up.output();
  EXPECT_THAT(back_up.output(), HasSubstr("models.sqlite, windows.sqlite, requests.sqlite"));
  EXPECT_EQ(Upkeeper("--backup", backup).Wait(), 1);   // it is there already
  EXPECT_EQ(Upkeeper("--restore", backup).Wait(), 1);  // a daemon uses the directory
  daemon->Signal(SIGKILL);
  daemon->Wait();

  std::filesystem::remove_all(State());
  Process restore = Upkeeper("--restore", backup);
  ASSERT_EQ(restore.Wait(), 0) << restore.output();
  daemon = StartDaemon();
  EXPECT_TRUE(daemon->WaitForOutput("published revision 1"));
  EXPECT_TRUE(AwaitQuality(kVehicleId, [](const Quality& q) { return q.window_s > 299.0; }));
  daemon->Signal(SIGTERM);
  daemon->Wait();

  // A damaged backup, or none, changes nothing.
  std::filesystem::resize_file(backup / "models.sqlite", 5000);
  EXPECT_EQ(Upkeeper("--restore", backup).Wait(), 1);
  EXPECT_EQ(Upkeeper("--restore", folder_.Path() / "nowhere").Wait(), 1);
  EXPECT_TRUE(StartDaemon()->WaitForOutput("published revision 1"));
}

}  // namespace
}  // namespace telltale
