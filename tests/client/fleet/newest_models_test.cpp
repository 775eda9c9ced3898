#include "telltale/client/fleet/newest_models.hpp"

#include <gtest/gtest.h>

namespace telltale {
namespace {

PublishedModel ModelOf(const std::string& vehicle_id, std::uint64_t revision, double unix_s) {
  PublishedModel model;
  model.identification.vehicle_id = vehicle_id;
  model.revision = revision;
  model.published_unix_s = unix_s;
  return model;
}

TEST(NewestModels, AdmitsWhatIsNewerAndTheSameAgain) {
  NewestModels models;
  EXPECT_TRUE(models.Admit(ModelOf("one", 1, 100.0)));
  EXPECT_TRUE(models.Admit(ModelOf("one", 2, 200.0)));
  EXPECT_TRUE(models.Admit(ModelOf("one", 2, 200.0)));
}

TEST(NewestModels, PassesOverAnOlderModelOfTheSameVehicleAlone) {
  NewestModels models;
  EXPECT_TRUE(models.Admit(ModelOf("one", 26, 500.0)));
  EXPECT_FALSE(models.Admit(ModelOf("one", 2, 200.0)));
  EXPECT_TRUE(models.Admit(ModelOf("two", 2, 200.0)));
  EXPECT_TRUE(models.Admit(ModelOf("one", 27, 600.0)));
}

// Its store was lost or put back to an earlier state.
TEST(NewestModels, AdmitsALowerRevisionThatWasMadeLater) {
  NewestModels models;
  EXPECT_TRUE(models.Admit(ModelOf("one", 26, 500.0)));
  EXPECT_TRUE(models.Admit(ModelOf("one", 1, 600.0)));
  EXPECT_TRUE(models.Admit(ModelOf("one", 2, 700.0)));
}

}  // namespace
}  // namespace telltale
