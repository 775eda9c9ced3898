#include "telltale/service/models/model_store.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/made_up_identifications.hpp"
#include "support/special_values.hpp"
#include "support/temporary_folder.hpp"
#include "telltale/idl/codec/json/model.hpp"

namespace telltale {
namespace {

class ModelStoreTest : public ::testing::Test {
 protected:
  TemporaryFolder folder_;
  Identification model_ = MadeUpIdentification();
};

TEST_F(ModelStoreTest, CountsRevisionsPerVehicleAcrossReopening) {
  {
    ModelStore store(folder_.Path());
    EXPECT_EQ(store.Save(model_, 1.0, std::nullopt).model.revision, 1u);
    EXPECT_EQ(store.Save(model_, 2.0, std::nullopt).model.revision, 2u);
  }
  ModelStore store(folder_.Path());
  EXPECT_EQ(store.Save(model_, 3.0, std::nullopt).model.revision, 3u);
  model_.vehicle_id = "another";
  EXPECT_EQ(store.Save(model_, 4.0, std::nullopt).model.revision, 1u);
}

TEST_F(ModelStoreTest, GivesBackTheNewestAsItWasSaved) {
  ModelStore(folder_.Path()).Save(model_, 12.5, FreeRunError{0.1, 0.2, 0.3});
  const auto latest = ModelStore(folder_.Path()).Latest(model_.vehicle_id);
  ASSERT_TRUE(latest);
  EXPECT_EQ(latest->model.revision, 1u);
  EXPECT_EQ(latest->model.published_unix_s, 12.5);
  EXPECT_EQ(latest->reference_error, (FreeRunError{0.1, 0.2, 0.3}));
  EXPECT_EQ(PrintModelJson(latest->model.identification), PrintModelJson(model_));
}

TEST_F(ModelStoreTest, HasNothingOfAVehicleItNeverSaw) {
  EXPECT_FALSE(ModelStore(folder_.Path()).Latest("stranger"));
}

TEST_F(ModelStoreTest, FallsBackOnTheNewestThatCanBeRead) {
  ModelStore store(folder_.Path());
  store.Save(model_, 1.0, std::nullopt);
  store.Save(model_, 2.0, std::nullopt);
  SQLite::Database(folder_.Path() / "models.sqlite", SQLite::OPEN_READWRITE)
      .exec("UPDATE models SET model = x'ff00ff' WHERE revision = 2");
  ASSERT_TRUE(store.Latest(model_.vehicle_id));
  EXPECT_EQ(store.Latest(model_.vehicle_id)->model.revision, 1u);
  EXPECT_EQ(store.Save(model_, 3.0, std::nullopt).model.revision, 3u);
}

TEST_F(ModelStoreTest, PassesOverAModelWithAFlippedBit) {
  ModelStore store(folder_.Path());
  store.Save(model_, 1.0, std::nullopt);
  store.Save(model_, 2.0, std::nullopt);
  // The last byte of a finite number: the message can still be read.
  SQLite::Database database(folder_.Path() / "models.sqlite", SQLite::OPEN_READWRITE);
  SQLite::Statement read(database, "SELECT model FROM models WHERE revision = 2");
  read.executeStep();
  std::string blob = read.getColumn(0).getString();
  read.reset();
  blob.back() = static_cast<char>(blob.back() ^ 1);
  SQLite::Statement write(database, "UPDATE models SET model = ? WHERE revision = 2");
  write.bind(1, blob.data(), static_cast<int>(blob.size()));
  write.exec();
  ASSERT_TRUE(store.Latest(model_.vehicle_id));
  EXPECT_EQ(store.Latest(model_.vehicle_id)->model.revision, 1u);
}

TEST_F(ModelStoreTest, KeepsTheNewestTwoHundredOfEachVehicleAndAShortLog) {
  ModelStore store(folder_.Path());
  for (int i = 0; i < 210; ++i) store.Save(model_, i, std::nullopt);
  SQLite::Database database(folder_.Path() / "models.sqlite");
  EXPECT_EQ(database.execAndGet("SELECT COUNT(*) FROM models").getInt(), 200);
  EXPECT_EQ(database.execAndGet("SELECT MIN(revision) FROM models").getInt(), 11);
  EXPECT_GT(std::filesystem::file_size(folder_.Path() / "models.sqlite"), 500'000u);
  EXPECT_LT(std::filesystem::file_size(folder_.Path() / "models.sqlite-wal"), 3'000'000u);
}

TEST_F(ModelStoreTest, ReadsWhatADamagedFileStillHolds) {
  {
    ModelStore store(folder_.Path());
    for (int i = 0; i < 50; ++i) store.Save(model_, i, std::nullopt);
  }
  const auto file = folder_.Path() / "models.sqlite";
  const auto size = std::filesystem::file_size(file);
  {
    std::fstream bytes(file, std::ios::in | std::ios::out | std::ios::binary);
    bytes.seekp(static_cast<std::streamoff>(size / 2 / 4096 * 4096));
    bytes << std::string(16 * 4096, 'x');
  }
  ModelStore store(folder_.Path());
  ASSERT_TRUE(store.Latest(model_.vehicle_id));
  EXPECT_EQ(store.Latest(model_.vehicle_id)->model.revision, 50u);
  const auto set_aside = std::ranges::count_if(
      std::filesystem::directory_iterator(folder_.Path()), [](const auto& entry) {
        return entry.path().filename().string().starts_with("models.sqlite.damaged-");
      });
  EXPECT_EQ(set_aside, 1);
}

TEST_F(ModelStoreTest, StartsAgainBesideAFileThatIsNoDatabase) {
  folder_.Write("models.sqlite", std::string(10000, 'x'));
  ModelStore store(folder_.Path());
  EXPECT_EQ(store.Save(model_, 1.0, std::nullopt).model.revision, 1u);
}

TEST_F(ModelStoreTest, KeepsNothingThatNobodyCouldRead) {
  ModelStore store(folder_.Path());
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

}  // namespace
}  // namespace telltale
