#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "service/service_fixture.hpp"
#include "support/stable_boat.hpp"

namespace telltale {
namespace {

using ::testing::HasSubstr;

/// A daemon that renews the models of its boat by itself.
class UpkeepOfDaemon : public ServiceTest {
 protected:
  void Configure(const std::string& upkeep) {
    config_file_ = folder_.Write("upkeep.textproto",
                                 "domain: " + std::to_string(domain_.id()) +
                                     "\nvehicle_files: \"vehicle.textproto\"\nstate_directory: \"" +
                                     (folder_.Path() / "state").string() +
                                     "\"\nidentification { bootstrap_replicates: 100 structure: "
                                     "\"static\" }\nquality_period_s: 0.1\n"
                                     "window { save_period_s: 0.2 }\nupkeep { retry_s: 1 " +
                                     upkeep + " }\n");
  }
};

TEST_F(UpkeepOfDaemon, IdentifiesABoatWithoutAModelUnasked) {
  Configure("refresh: \"act\" refresh_older_than_s: 86400");
  const auto daemon = StartDaemon();
  Replay(SimulatedRecording(testing::StableBoat(), 0.0, 300.0, 4));
  EXPECT_TRUE(AwaitQuality(kVehicleId, [](const Quality& q) { return q.model_revision == 1u; }));
  EXPECT_TRUE(daemon->WaitForOutput("a refresh is due: it has no model"));
}

TEST_F(UpkeepOfDaemon, SaysWhatIsDueAndChangesNothingWhereItAdvises) {
  Configure("refresh: \"advise\" refresh_older_than_s: 86400");
  const auto daemon = StartDaemon();
  Replay(SimulatedRecording(testing::StableBoat(), 0.0, 300.0, 4));
  const auto advised = AwaitQuality(
      kVehicleId, [](const Quality& q) { return q.proposal.find("due") != std::string::npos; });
  ASSERT_TRUE(advised);
  EXPECT_THAT(advised->proposal, HasSubstr("telltale refresh --vehicle-id yellowfish"));
  EXPECT_FALSE(advised->model_revision);
  // Once it has a model, nothing is due.
  Run({"identify", "--vehicle-id", kVehicleId});
  EXPECT_TRUE(AwaitQuality(
      kVehicleId, [](const Quality& q) { return q.model_revision == 1u && q.proposal.empty(); }));
}

}  // namespace
}  // namespace telltale
