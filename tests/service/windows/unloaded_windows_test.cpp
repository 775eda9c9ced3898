#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "service/service_fixture.hpp"
#include "support/stable_boat.hpp"
#include "telltale/core/data/recording_parts.hpp"
#include "telltale/service/models/model_store.hpp"

namespace telltale {
namespace {

using ::testing::HasSubstr;

/// A daemon that unloads the window of a boat ten seconds after its last sample or reader, which is
/// more than an identification takes without replicates.
class UnloadedWindows : public ServiceTest, public ::testing::WithParamInterface<Engine> {
 protected:
  UnloadedWindows() : ServiceTest(GetParam()) {
    ConfigureIdentification("bootstrap_replicates: 0 structure: \"static\"", {"vehicle.textproto"},
                            "unload_after_s: 10");
    Configure("http { port: 0 }\n");
  }

  bool AwaitUnloaded(const Process& daemon, double windows) const {
    return AwaitMetric(daemon, "telltale_windows_unloaded", windows);
  }

  static double Bytes(const Process& daemon) {
    return Metric(daemon, "telltale_vehicle_window_bytes{vehicle_id=\"yellowfish\"}").value_or(-1);
  }

  std::string Output(const std::vector<std::string>& arguments) const {
    const auto command = Start(arguments);
    EXPECT_EQ(command->Wait(), 0) << command->output();
    return command->output();
  }
};

INSTANTIATE_TEST_SUITE_P(Engines, UnloadedWindows, kEngines, EngineName);

TEST_P(UnloadedWindows, ComeBackWithARequestAndWithASample) {
  const Recording run = SimulatedRecording(testing::StableBoat(), 0.0, 360.0, 4);
  const auto daemon = StartDaemon();
  Replay(Between(run, 0.0, 300.0));
  EXPECT_GT(Bytes(*daemon), 0.0);
  Output({"identify", "--vehicle-id", kVehicleId});

  ASSERT_TRUE(AwaitUnloaded(*daemon, 1.0));
  const auto silent = AwaitQuality(kVehicleId, [](const Quality& quality) {
    return quality.verdict == QualityVerdict::kStale && quality.window_bytes == 0;
  });
  ASSERT_TRUE(silent);
  EXPECT_NEAR(silent->window_s, 300.0, 1.0);
  EXPECT_THAT(Output({"list"}), HasSubstr("300"));
  EXPECT_THAT(Output({"refresh", "--all"}), HasSubstr("UNCHANGED"));
  EXPECT_EQ(Metric(*daemon, "telltale_windows_unloaded"), 1.0);

  Output({"identify", "--vehicle-id", kVehicleId});
  EXPECT_EQ(Metric(*daemon, "telltale_windows_unloaded"), 0.0);
  const auto models = ModelStore(Storage()).History(kVehicleId);
  ASSERT_EQ(models.size(), 2u);
  const Identification& now = models[0].model.identification;
  const Identification& before = models[1].model.identification;
  EXPECT_EQ(now.window.samples, before.window.samples);
  EXPECT_EQ(now.window.end_s, before.window.end_s);
  ASSERT_EQ(now.coefficients.size(), before.coefficients.size());
  for (std::size_t i = 0; i < now.coefficients.size(); ++i) {
    EXPECT_EQ(now.coefficients[i].estimate, before.coefficients[i].estimate);
  }

  ASSERT_TRUE(AwaitUnloaded(*daemon, 1.0));
  Replay(Between(run, 300.0, 360.0));
  EXPECT_TRUE(daemon->WaitForOutput("sends again; its window is read back"));
  const auto grown =
      AwaitQuality(kVehicleId, [](const Quality& quality) { return quality.window_s > 359.0; });
  ASSERT_TRUE(grown);
  EXPECT_TRUE(grown->rejected.empty());
  EXPECT_GT(grown->window_bytes, 0u);
}

}  // namespace
}  // namespace telltale
