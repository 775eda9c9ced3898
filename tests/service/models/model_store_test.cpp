#include "telltale/service/models/model_store.hpp"

#include <stdexcept>

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
