#include "telltale/service/registry/vehicle_store.hpp"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "service/registry/made_up_boat.hpp"
#include "service/storage_fixture.hpp"
#include "telltale/idl/codec/vehicle_file.hpp"
#include "telltale/service/storage/backup.hpp"
#include "telltale/service/storage/stores.hpp"

namespace telltale {
namespace {

using testing::Boat;
using ::testing::ElementsAre;
using ::testing::UnorderedElementsAre;

VehicleStore::Change Kept(const Vehicle& vehicle) {
  return {vehicle.vehicle_id, vehicle};
}

std::vector<std::string> Stored(const Storage& storage) {
  std::vector<std::string> texts;
  for (const Vehicle& vehicle : VehicleStore(storage).All()) {
    texts.push_back(PrintVehicle(vehicle));
  }
  return texts;
}

class VehicleStoreTest : public StorageTest {};

INSTANTIATE_TEST_SUITE_P(Engines, VehicleStoreTest, kEngines, EngineName);

TEST_P(VehicleStoreTest, GivesBackWhatWasKeptLast) {
  {
    VehicleStore store(Storage());
    EXPECT_THAT(store.Save({Kept(Boat("b")), Kept(Boat("a")), Kept(Boat("c"))}),
                UnorderedElementsAre("a", "b", "c"));
    EXPECT_THAT(store.Save({Kept(Boat("b", 31.0)), {"c", std::nullopt}, {"d", std::nullopt}}),
                UnorderedElementsAre("b", "c", "d"));
  }
  EXPECT_THAT(Stored(Storage()),
              ElementsAre(PrintVehicle(Boat("a")), PrintVehicle(Boat("b", 31.0))));
}

TEST_P(VehicleStoreTest, PassesOverWhatIsDamaged) {
  VehicleStore(Storage()).Save({Kept(Boat("a")), Kept(Boat("b"))});
  // One bit of the mass: it could still be read as a vehicle.
  const auto database = Storage().Open(VehiclesSchema());
  std::string bytes;
  database->Query("SELECT vehicle FROM announced_vehicles WHERE vehicle_id = 'a'", {},
                  [&](const Row& row) { bytes = row.Bytes("vehicle"); });
  bytes.back() ^= 1;
  database->Execute("UPDATE announced_vehicles SET vehicle = $1 WHERE vehicle_id = 'a'",
                    {Blob(bytes)});
  EXPECT_THAT(Stored(Storage()), ElementsAre(PrintVehicle(Boat("b"))));
}

TEST(VehicleStoreBackup, HasTheBoats) {
  const TemporaryFolder folder;
  const auto state = folder.Path() / "state";
  std::filesystem::create_directory(state);
  const telltale::Storage storage(state);
  VehicleStore(storage).Save({Kept(Boat("a"))});
  BackUp(state, folder.Path() / "backup");
  VehicleStore(storage).Save({{"a", std::nullopt}, Kept(Boat("b"))});
  RestoreBackup(folder.Path() / "backup", state);
  EXPECT_THAT(Stored(storage), ElementsAre(PrintVehicle(Boat("a"))));
}

}  // namespace
}  // namespace telltale
