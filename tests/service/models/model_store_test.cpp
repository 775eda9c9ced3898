#include "telltale/service/models/model_store.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "service/storage_fixture.hpp"
#include "support/made_up_identifications.hpp"
#include "support/special_values.hpp"
#include "support/temporary_folder.hpp"
#include "telltale/idl/codec/json/model.hpp"
#include "telltale/service/storage/stores.hpp"

namespace telltale {
namespace {

using namespace std::string_view_literals;

class ModelStoreTest : public StorageTest {
 protected:
  Identification model_ = MadeUpIdentification();
};

INSTANTIATE_TEST_SUITE_P(Engines, ModelStoreTest, kEngines, EngineName);

/// What only a file of its own can suffer.
class SqliteModelStore : public ::testing::Test {
 protected:
  telltale::Storage Storage() const { return telltale::Storage(folder_.Path()); }

  TemporaryFolder folder_;
  Identification model_ = MadeUpIdentification();
};

TEST_P(ModelStoreTest, CountsRevisionsPerVehicleAcrossReopening) {
  {
    ModelStore store(Storage());
    EXPECT_EQ(store.Save(model_, 1.0, std::nullopt).model.revision, 1u);
    EXPECT_EQ(store.Save(model_, 2.0, std::nullopt).model.revision, 2u);
  }
  ModelStore store(Storage());
  EXPECT_EQ(store.Save(model_, 3.0, std::nullopt).model.revision, 3u);
  model_.vehicle_id = "another";
  EXPECT_EQ(store.Save(model_, 4.0, std::nullopt).model.revision, 1u);
}

TEST_P(ModelStoreTest, GivesBackTheNewestAsItWasSaved) {
  ModelStore(Storage()).Save(model_, 12.5, FreeRunError{0.1, 0.2, 0.3});
  const auto latest = ModelStore(Storage()).Latest(model_.vehicle_id);
  ASSERT_TRUE(latest);
  EXPECT_EQ(latest->model.revision, 1u);
  EXPECT_EQ(latest->model.published_unix_s, 12.5);
  EXPECT_EQ(latest->reference_error, (FreeRunError{0.1, 0.2, 0.3}));
  EXPECT_EQ(PrintModelJson(latest->model.identification), PrintModelJson(model_));
}

TEST_P(ModelStoreTest, KeepsTheModelOfAnotherDaemonUnderItsRevision) {
  ModelStore store(Storage());
  const Promotion promotion{PromotionVerdict::kWarn, "the reason of the other"};
  store.Keep({{model_, 7, 12.5, promotion}, FreeRunError{0.1, 0.2, 0.3}});
  const auto latest = ModelStore(Storage()).Latest(model_.vehicle_id);
  ASSERT_TRUE(latest);
  EXPECT_EQ(latest->model.revision, 7u);
  EXPECT_EQ(latest->model.published_unix_s, 12.5);
  EXPECT_EQ(latest->model.promotion.verdict, promotion.verdict);
  EXPECT_EQ(latest->model.promotion.reason, promotion.reason);
  EXPECT_EQ(latest->reference_error, (FreeRunError{0.1, 0.2, 0.3}));
  EXPECT_EQ(PrintModelJson(latest->model.identification), PrintModelJson(model_));
  EXPECT_EQ(store.Save(model_, 13.0, std::nullopt).model.revision, 8u);
}

TEST_P(ModelStoreTest, KeepsTheModelOfAnotherDaemonInPlaceOfItsOwn) {
  ModelStore store(Storage());
  store.Save(model_, 1.0, std::nullopt);
  store.Save(model_, 2.0, std::nullopt);
  store.Keep({{model_, 1, 1.5, {}}, {}});
  const auto history = store.History(model_.vehicle_id);
  ASSERT_EQ(history.size(), 2u);
  EXPECT_EQ(history[0].model.published_unix_s, 2.0);
  EXPECT_EQ(history[1].model.published_unix_s, 1.5);
}

TEST_P(ModelStoreTest, ListsTheRevisionsOfOneVehicleOldestFirst) {
  ModelStore store(Storage());
  for (const std::uint64_t revision : {9u, 4u, 6u}) store.Keep({{model_, revision, 1.0, {}}, {}});
  const std::string vehicle_id = std::exchange(model_.vehicle_id, "another");
  store.Save(model_, 1.0, std::nullopt);
  EXPECT_THAT(store.Revisions(vehicle_id), ::testing::ElementsAre(4, 6, 9));
  EXPECT_THAT(store.Revisions("stranger"), ::testing::IsEmpty());
}

TEST_P(ModelStoreTest, HasNothingOfAVehicleItNeverSaw) {
  EXPECT_FALSE(ModelStore(Storage()).Latest("stranger"));
}

TEST_P(ModelStoreTest, FallsBackOnTheNewestThatCanBeRead) {
  ModelStore store(Storage());
  store.Save(model_, 1.0, std::nullopt);
  store.Save(model_, 2.0, std::nullopt);
  Storage()
      .Open(ModelsSchema())
      ->Execute("UPDATE models SET model = $1 WHERE revision = 2", {Blob("\xff\0\xff"sv)});
  ASSERT_TRUE(store.Latest(model_.vehicle_id));
  EXPECT_EQ(store.Latest(model_.vehicle_id)->model.revision, 1u);
  EXPECT_EQ(store.Save(model_, 3.0, std::nullopt).model.revision, 3u);
}

TEST_P(ModelStoreTest, PassesOverAModelWithAFlippedBit) {
  ModelStore store(Storage());
  store.Save(model_, 1.0, std::nullopt);
  store.Save(model_, 2.0, std::nullopt);
  // The last byte of a finite number: the message can still be read.
  const auto database = Storage().Open(ModelsSchema());
  std::string blob;
  database->Query("SELECT model FROM models WHERE revision = 2", {},
                  [&](const Row& row) { blob = row.Bytes("model"); });
  blob.back() = static_cast<char>(blob.back() ^ 1);
  database->Execute("UPDATE models SET model = $1 WHERE revision = 2", {Blob(blob)});
  ASSERT_TRUE(store.Latest(model_.vehicle_id));
  EXPECT_EQ(store.Latest(model_.vehicle_id)->model.revision, 1u);
}

TEST_P(ModelStoreTest, KeepsTheNewestTwoHundredOfEachVehicle) {
  ModelStore store(Storage());
  for (int i = 0; i < 210; ++i) store.Save(model_, i, std::nullopt);
  const auto history = store.History(model_.vehicle_id);
  ASSERT_EQ(history.size(), 200u);
  EXPECT_EQ(history.front().model.revision, 210u);
  EXPECT_EQ(history.back().model.revision, 11u);
}

// As docs/guides/postgresql.md says.
TEST(PostgresModelStore, ComesBackFromADumpThatWasMadeWhileItWasUsed) {
  EngineStorage engine(Engine::kPostgres);
  Identification model = MadeUpIdentification();
  ModelStore store(engine.Storage());
  store.Save(model, 1.0, std::nullopt);
  const std::string dump = engine.Folder().Path() / "dump";
  const std::string restored = engine.Server().Address("restored");
  EXPECT_EQ(
      Process({"/usr/bin/pg_dump", "--format", "custom", "--file", dump, engine.Server().Address()})
          .Wait(),
      0);
  store.Save(model, 2.0, std::nullopt);
  EXPECT_EQ(
      Process({"/usr/bin/createdb", "--maintenance-db", engine.Server().Address(), "restored"})
          .Wait(),
      0);
  EXPECT_EQ(Process({"/usr/bin/pg_restore", "--dbname", restored, "--no-owner", dump}).Wait(), 0);
  ModelStore again(Storage(engine.Folder().Path(), restored));
  ASSERT_TRUE(again.Latest(model.vehicle_id));
  EXPECT_EQ(again.Latest(model.vehicle_id)->model.published_unix_s, 1.0);
  EXPECT_EQ(again.Save(model, 3.0, std::nullopt).model.revision, 2u);
}

TEST_F(SqliteModelStore, KeepsAShortLog) {
  ModelStore store(Storage());
  for (int i = 0; i < 100; ++i) store.Save(model_, i, std::nullopt);
  EXPECT_GT(std::filesystem::file_size(folder_.Path() / "models.sqlite"), 500'000u);
  EXPECT_LT(std::filesystem::file_size(folder_.Path() / "models.sqlite-wal"), 3'000'000u);
}

TEST_F(SqliteModelStore, ReadsWhatADamagedFileStillHolds) {
  {
    ModelStore store(Storage());
    for (int i = 0; i < 50; ++i) store.Save(model_, i, std::nullopt);
  }
  const auto file = folder_.Path() / "models.sqlite";
  const auto size = std::filesystem::file_size(file);
  {
    std::fstream bytes(file, std::ios::in | std::ios::out | std::ios::binary);
    bytes.seekp(static_cast<std::streamoff>(size / 2 / 4096 * 4096));
    bytes << std::string(16 * 4096, 'x');
  }
  ModelStore store(Storage());
  ASSERT_TRUE(store.Latest(model_.vehicle_id));
  EXPECT_EQ(store.Latest(model_.vehicle_id)->model.revision, 50u);
  const auto set_aside = std::ranges::count_if(
      std::filesystem::directory_iterator(folder_.Path()), [](const auto& entry) {
        return entry.path().filename().string().starts_with("models.sqlite.damaged-");
      });
  EXPECT_EQ(set_aside, 1);
}

TEST_F(SqliteModelStore, StartsAgainBesideAFileThatIsNoDatabase) {
  folder_.Write("models.sqlite", std::string(10000, 'x'));
  ModelStore store(Storage());
  EXPECT_EQ(store.Save(model_, 1.0, std::nullopt).model.revision, 1u);
}

TEST_P(ModelStoreTest, KeepsNothingThatNobodyCouldRead) {
  ModelStore store(Storage());
  store.Save(model_, 1.0, std::nullopt);
  Identification wrong = model_;
  wrong.coefficients[3].standard_error = kNan;
  try {
    store.Save(wrong, 2.0, std::nullopt);
    ADD_FAILURE() << "it was kept";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("coefficients[3].standardError = nan"));
  }
  EXPECT_EQ(store.Save(model_, 3.0, std::nullopt).model.revision, 2u);
}

// Its models have neither verdict nor checksum.
TEST_F(SqliteModelStore, BringsAStoreOfVersionTwoToItsOwn) {
  {
    ModelStore store(Storage());
    store.Save(model_, 1.0, std::nullopt);
  }
  {
    SQLite::Database old(folder_.Path() / "models.sqlite", SQLite::OPEN_READWRITE);
    for (const char* column : {"verdict", "verdict_reason", "checksum"}) {
      old.exec(std::string("ALTER TABLE models DROP COLUMN ") + column);
    }
    old.exec("DROP TABLE diagnoses");
    old.exec("PRAGMA user_version = 2");
  }
  ModelStore store(Storage());
  ASSERT_TRUE(store.Latest(model_.vehicle_id));
  EXPECT_EQ(store.Latest(model_.vehicle_id)->model.promotion.verdict, PromotionVerdict::kUnknown);
  EXPECT_EQ(store.Save(model_, 2.0, std::nullopt).model.revision, 2u);
}

}  // namespace
}  // namespace telltale
