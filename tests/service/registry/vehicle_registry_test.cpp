#include "telltale/service/registry/vehicle_registry.hpp"

#include <chrono>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "service/registry/made_up_boat.hpp"
#include "service/storage_fixture.hpp"

namespace telltale {
namespace {

using namespace std::chrono_literals;
using testing::Boat;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

class VehicleRegistryTest : public StorageTest {
 protected:
  VehicleRegistry Registry(std::vector<Vehicle> configured = {}) const {
    return {Storage(), std::move(configured), rule_};
  }

  Admission Announce(VehicleRegistry& registry, const Vehicle& vehicle) const {
    return registry.Announce(vehicle, now_);
  }

  static std::vector<std::string> IdsOf(const VehicleRegistry& registry) {
    std::vector<std::string> ids;
    for (const Vehicle& vehicle : registry.Vehicles()) {
      ids.push_back(vehicle.vehicle_id);
      EXPECT_TRUE(registry.Contains(ids.back()));
    }
    return ids;
  }

  AnnouncedSettings rule_{.admit = {"boat-*", "buoy.?"}};
  VehicleRegistry::Clock::time_point now_;
};

INSTANTIATE_TEST_SUITE_P(Engines, VehicleRegistryTest, kEngines, EngineName);

TEST_P(VehicleRegistryTest, AdmitsWhatAPatternHas) {
  VehicleRegistry registry = Registry();
  EXPECT_EQ(Announce(registry, Boat("boat-7")), Admission::kAdmitted);
  EXPECT_EQ(Announce(registry, Boat("boat-")), Admission::kAdmitted);
  EXPECT_EQ(Announce(registry, Boat("buoy.1")), Admission::kAdmitted);
  EXPECT_EQ(Announce(registry, Boat("buoyx1")), Admission::kNotAdmitted);
  EXPECT_EQ(Announce(registry, Boat("buoy.12")), Admission::kNotAdmitted);
  EXPECT_EQ(Announce(registry, Boat("my-boat-7")), Admission::kNotAdmitted);
  EXPECT_EQ(Announce(registry, Boat("boat-7")), Admission::kKnown);
  EXPECT_THAT(IdsOf(registry), ElementsAre("boat-", "boat-7", "buoy.1"));
  EXPECT_FALSE(registry.Contains("buoyx1"));
}

TEST_P(VehicleRegistryTest, AdmitsNoneWithoutARule) {
  rule_ = {};
  VehicleRegistry registry = Registry();
  EXPECT_EQ(Announce(registry, Boat("boat-7")), Admission::kNotAdmitted);
  EXPECT_THAT(IdsOf(registry), IsEmpty());
}

TEST_P(VehicleRegistryTest, HoldsToTheConfiguration) {
  VehicleRegistry registry = Registry({Boat("boat-1", 11.0), Boat("other", 12.0)});
  EXPECT_EQ(Announce(registry, Boat("boat-1", 99.0)), Admission::kConfigured);
  EXPECT_EQ(Announce(registry, Boat("other", 99.0)), Admission::kConfigured);
  EXPECT_EQ(Announce(registry, Boat("boat-2", 20.0)), Admission::kAdmitted);
  EXPECT_FALSE(registry.Retire("boat-1"));
  // Now a file names the boat that had announced itself.
  registry.Configure({Boat("boat-2", 13.0)}, rule_);
  ASSERT_THAT(IdsOf(registry), ElementsAre("boat-2"));
  EXPECT_EQ(registry.Vehicles().front().mass_kg, 13.0);
  registry.Configure({}, rule_);
  ASSERT_THAT(IdsOf(registry), ElementsAre("boat-2"));
  EXPECT_EQ(registry.Vehicles().front().mass_kg, 20.0);
}

TEST_P(VehicleRegistryTest, HasAfterARestartWhatItStored) {
  {
    VehicleRegistry registry = Registry();
    for (const char* id : {"boat-1", "boat-2", "boat-3"}) Announce(registry, Boat(id));
    EXPECT_EQ(Announce(registry, Boat("boat-2", 31.0)), Admission::kChanged);
    EXPECT_TRUE(registry.Retire("boat-3"));
    EXPECT_FALSE(registry.Retire("boat-3"));
    EXPECT_TRUE(registry.HasUnstored());
    registry.Store();
    EXPECT_FALSE(registry.HasUnstored());
    Announce(registry, Boat("boat-4"));  // and dies before it stores it
  }
  {
    VehicleRegistry registry = Registry();
    ASSERT_THAT(IdsOf(registry), ElementsAre("boat-1", "boat-2"));
    EXPECT_EQ(registry.Vehicles()[1].mass_kg, 31.0);
    EXPECT_EQ(Announce(registry, Boat("boat-2", 31.0)), Admission::kKnown);
    EXPECT_TRUE(registry.Retire("boat-2"));
    registry.Store();
  }
  EXPECT_THAT(IdsOf(Registry()), ElementsAre("boat-1"));
}

TEST_P(VehicleRegistryTest, ServesNoBoatThatTheRuleNoLongerAdmitsAndKeepsItStored) {
  VehicleRegistry before = Registry();
  Announce(before, Boat("boat-1"));
  Announce(before, Boat("buoy.1"));
  before.Store();
  rule_.admit = {"buoy.*"};
  VehicleRegistry registry = Registry();
  EXPECT_THAT(IdsOf(registry), ElementsAre("buoy.1"));
  EXPECT_FALSE(registry.Contains("boat-1"));
  registry.Configure({}, {.admit = {"*"}});
  EXPECT_THAT(IdsOf(registry), ElementsAre("boat-1", "buoy.1"));
}

TEST_P(VehicleRegistryTest, AdmitsNoMoreThanTheLimit) {
  rule_.most = 2;
  VehicleRegistry registry = Registry();
  EXPECT_EQ(Announce(registry, Boat("boat-1")), Admission::kAdmitted);
  EXPECT_EQ(Announce(registry, Boat("boat-2")), Admission::kAdmitted);
  EXPECT_EQ(Announce(registry, Boat("boat-3")), Admission::kBeyondLimit);
  EXPECT_EQ(Announce(registry, Boat("boat-2", 31.0)), Admission::kChanged);
  EXPECT_TRUE(registry.Retire("boat-2"));
  EXPECT_EQ(Announce(registry, Boat("boat-3")), Admission::kBeyondLimit) << "it has had two";
  EXPECT_EQ(Announce(registry, Boat("boat-2")), Admission::kAdmitted);
  registry.Retire("boat-2");
  registry.Store();
  VehicleRegistry restarted = Registry();
  EXPECT_EQ(Announce(restarted, Boat("boat-3")), Admission::kAdmitted);
}

TEST_P(VehicleRegistryTest, LetsABoatChangeFiveTimesInTenMinutes) {
  VehicleRegistry registry = Registry();
  EXPECT_EQ(Announce(registry, Boat("boat-1", 1.0)), Admission::kAdmitted);
  for (int i = 2; i <= 5; ++i) {
    EXPECT_EQ(Announce(registry, Boat("boat-1", i)), Admission::kChanged) << i;
  }
  EXPECT_EQ(Announce(registry, Boat("boat-1", 6.0)), Admission::kTooManyChanges);
  EXPECT_EQ(registry.Vehicles().front().mass_kg, 5.0);
  registry.Retire("boat-1");
  EXPECT_EQ(Announce(registry, Boat("boat-1", 1.0)), Admission::kTooManyChanges);
  EXPECT_EQ(Announce(registry, Boat("boat-2", 1.0)), Admission::kAdmitted) << "of each its own";
  now_ += 10min;
  EXPECT_EQ(Announce(registry, Boat("boat-1", 6.0)), Admission::kAdmitted);
}

TEST_P(VehicleRegistryTest, KnowsWhatOtherDaemonsHaveStored) {
  VehicleRegistry one = Registry();
  VehicleRegistry two = Registry();
  for (const char* id : {"boat-1", "boat-2", "boat-3"}) Announce(one, Boat(id));
  one.Store();
  Announce(two, Boat("boat-2", 31.0));  // which it has heard later
  two.ReadStored();
  two.Retire("boat-3");
  two.ReadStored();
  ASSERT_THAT(IdsOf(two), ElementsAre("boat-1", "boat-2"));
  EXPECT_EQ(two.Vehicles()[1].mass_kg, 31.0);
}

}  // namespace
}  // namespace telltale
