#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "service/service_fixture.hpp"
#include "support/made_up_identifications.hpp"
#include "telltale/client/fleet/unix_now.hpp"
#include "telltale/service/models/model_store.hpp"

namespace telltale {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class RetentionDaemon : public ServiceTest, public ::testing::WithParamInterface<Engine> {
 protected:
  RetentionDaemon() : ServiceTest(GetParam()) {}

  void SaveModels(int models) const {
    Identification model = MadeUpIdentification();
    model.vehicle_id = kVehicleId;
    ModelStore store(Storage());
    for (int i = 0; i < models; ++i) {
      store.Save(model, UnixNow(), {}, {PromotionVerdict::kOk, ""});
    }
  }

  /// What `telltale` says, after it has exited with this code.
  std::string Output(const std::vector<std::string>& arguments, int exit_code) const {
    const auto command = Start(arguments);
    EXPECT_EQ(command->Wait(), exit_code) << command->output();
    return command->output();
  }
};

INSTANTIATE_TEST_SUITE_P(Engines, RetentionDaemon, kEngines, EngineName);

TEST_P(RetentionDaemon, RemovesEarlierModelsAndSaysSo) {
  SaveModels(5);
  Configure("retention { models_per_vehicle: 2 period_s: 1 }\nhttp { port: 0 }\n");
  const auto daemon = StartDaemon();
  ASSERT_TRUE(daemon->WaitForOutput("removed from the store: 3 model by count; it takes"));
  EXPECT_TRUE(AwaitMetric(
      *daemon, "telltale_store_rows_removed_total{kind=\"model\",reason=\"count\"}", 3.0));
  EXPECT_EQ(Metric(*daemon, "telltale_store_over_limit"), 0.0);
  EXPECT_GT(Metric(*daemon, "telltale_store_bytes{store=\"models\"}"), 1000.0);
  EXPECT_THAT(Output({"history", "--vehicle-id", kVehicleId}, 0),
              AllOf(HasSubstr("\n       5"), HasSubstr("\n       4"),
                    HasSubstr("3 of 5 revisions are no longer kept.")));
  EXPECT_THAT(Output({"rollback", "--vehicle-id", kVehicleId, "--revision", "3"}, 1),
              HasSubstr("that is kept"));
  EXPECT_THAT(Output({"rollback", "--vehicle-id", kVehicleId, "--revision", "4"}, 0),
              HasSubstr("published again as revision 6"));
  EXPECT_THAT(Output({"rollback", "--vehicle-id", kVehicleId, "--revision", "5"}, 0),
              HasSubstr("published again as revision 7"));
  EXPECT_TRUE(daemon->WaitForOutput("removed from the store: 1 model by count"));
  EXPECT_THAT(ModelStore(Storage()).Revisions(kVehicleId), ::testing::ElementsAre(5, 6, 7));
}

}  // namespace
}  // namespace telltale
