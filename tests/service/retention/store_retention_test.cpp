#include "telltale/service/retention/store_retention.hpp"

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "service/storage_fixture.hpp"
#include "support/made_up_diagnoses.hpp"
#include "support/made_up_identifications.hpp"
#include "telltale/client/fleet/unix_now.hpp"
#include "telltale/core/base/random.hpp"
#include "telltale/service/diagnosis/diagnosis_store.hpp"
#include "telltale/service/jobs/request_journal.hpp"
#include "telltale/service/models/model_store.hpp"
#include "telltale/service/storage/stores.hpp"
#include "telltale/service/windows/window_store.hpp"

namespace telltale {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Pair;

const Promotion kSound{PromotionVerdict::kOk, ""};
const Promotion kPoor{PromotionVerdict::kWarn, "it is poor"};

/// Nothing goes unless a test says so.
RetentionSettings KeepAll() {
  RetentionSettings settings;
  settings.window_age_s = 0.0;
  settings.store_bytes = 0;
  return settings;
}

class StoreRetentionTest : public StorageTest {
 protected:
  void SaveModels(const std::string& vehicle_id, const std::vector<double>& published_unix_s,
                  const Promotion& promotion = kSound) {
    ModelStore store(storage_);
    model_.vehicle_id = vehicle_id;
    for (const double unix_s : published_unix_s) store.Save(model_, unix_s, {}, promotion);
  }

  void SaveDiagnoses(const std::vector<double>& published_unix_s) const {
    DiagnosisStore store(storage_);
    PublishedDiagnosis diagnosis{MadeUpDiagnosis(), 1, 0.0};
    diagnosis.diagnosis.vehicle_id = "boat";
    for (const double unix_s : published_unix_s) {
      diagnosis.published_unix_s = unix_s;
      store.Save(diagnosis);
    }
  }

  /// Headings that cannot be compressed much.
  void SaveChunks(const std::string& vehicle_id, int chunks, int headings = 1) const {
    RandomEngine random(7);
    WindowStore store(storage_);
    for (int chunk = 0; chunk < chunks; ++chunk) {
      Recording samples;
      for (int i = 0; i < headings; ++i) {
        samples.heading.push_back(
            {static_cast<double>(chunk), static_cast<double>(random() >> 11) * 0x1p-50});
      }
      store.Save({{vehicle_id, samples}}, {1e9, 1'000'000});
    }
  }

  std::size_t ChunksOf(const std::string& vehicle_id) const {
    std::size_t chunks = 0;
    WindowStore(storage_).Load(vehicle_id, [&](const Recording&) { ++chunks; });
    return chunks;
  }

  std::vector<std::uint64_t> Revisions(const std::string& vehicle_id) const {
    return ModelStore(storage_).Revisions(vehicle_id);
  }

  std::vector<double> DiagnosisTimes() const {
    std::vector<double> times;
    for (const auto& diagnosis : DiagnosisStore(storage_).History("boat")) {
      times.push_back(diagnosis.published_unix_s);
    }
    return times;
  }

  RetentionPass Apply(const RetentionSettings& settings, double now_unix_s = 1000.0) const {
    return StoreRetention(storage_, settings,
                          [](const std::string& vehicle_id) { return vehicle_id != "former"; })
        .Apply(now_unix_s);
  }

  telltale::Storage storage_ = Storage();
  Identification model_ = MadeUpIdentification();
};

INSTANTIATE_TEST_SUITE_P(Engines, StoreRetentionTest, kEngines, EngineName);

TEST_P(StoreRetentionTest, RemovesNothingThatIsWithinTheLimits) {
  SaveModels("boat", {1.0, 2.0});
  SaveDiagnoses({1.0, 2.0});
  SaveChunks("former", 2);
  EXPECT_THAT(Apply(RetentionSettings()).removed, IsEmpty());
  EXPECT_THAT(Revisions("boat"), ElementsAre(1, 2));
  EXPECT_THAT(DiagnosisTimes(), ElementsAre(2.0, 1.0));
  EXPECT_EQ(ChunksOf("former"), 2u);
}

TEST_P(StoreRetentionTest, KeepsTheNewestModelsOfEachVehicle) {
  SaveModels("boat", {1.0, 2.0, 3.0, 4.0, 5.0});
  SaveModels("another", {1.0, 2.0});
  RetentionSettings settings = KeepAll();
  settings.models_per_vehicle = 3;
  EXPECT_THAT(Apply(settings).removed,
              ElementsAre(Pair(Pair(RemovedKind::kEarlierModel, RemovalReason::kCount), 2)));
  EXPECT_THAT(Revisions("boat"), ElementsAre(3, 4, 5));
  EXPECT_THAT(Revisions("another"), ElementsAre(1, 2));
  EXPECT_THAT(Apply(settings).removed, IsEmpty());
}

TEST_P(StoreRetentionTest, CountsRevisionsOnAfterItHasRemovedSome) {
  SaveModels("boat", {1.0, 2.0, 3.0});
  RetentionSettings settings = KeepAll();
  settings.models_per_vehicle = 2;
  Apply(settings);
  SaveModels("boat", {4.0});
  EXPECT_THAT(Revisions("boat"), ElementsAre(2, 3, 4));
}

TEST_P(StoreRetentionTest, KeepsTheNewestSoundModelBeforeTheNewestHoweverOldItIs) {
  SaveModels("boat", {1.0, 2.0});
  SaveModels("boat", {3.0, 4.0, 5.0}, kPoor);
  RetentionSettings settings = KeepAll();
  settings.model_age_s = 10.0;
  EXPECT_THAT(Apply(settings).removed,
              ElementsAre(Pair(Pair(RemovedKind::kEarlierModel, RemovalReason::kAge), 3)));
  EXPECT_THAT(Revisions("boat"), ElementsAre(2, 5));
}

TEST_P(StoreRetentionTest, KeepsTheModelThatARollbackHasPublishedAgain) {
  SaveModels("boat", {1.0, 2.0, 3.0, 4.0});
  ModelStore(storage_).Save(model_, 5.0, {}, kSound, 2);
  RetentionSettings settings = KeepAll();
  settings.model_age_s = 10.0;
  settings.models_per_vehicle = 2;
  Apply(settings);
  EXPECT_THAT(Revisions("boat"), ElementsAre(2, 4, 5));
  SaveModels("boat", {990.0, 995.0});
  Apply(settings);
  EXPECT_THAT(Revisions("boat"), ElementsAre(6, 7));
}

TEST_P(StoreRetentionTest, KeepsModelsDiagnosesAndWindowsForAsLongAsIsSaid) {
  SaveModels("boat", {1.0, 980.0, 995.0, 996.0});
  SaveDiagnoses({1.0, 980.0, 995.0});
  SaveChunks("boat", 3);
  RetentionSettings settings = KeepAll();
  settings.model_age_s = settings.diagnosis_age_s = 15.0;
  Apply(settings);
  EXPECT_THAT(Revisions("boat"), ElementsAre(3, 4));
  EXPECT_THAT(DiagnosisTimes(), ElementsAre(995.0));
  settings.window_age_s = 100.0;
  Apply(settings, UnixNow() + 50.0);
  EXPECT_EQ(ChunksOf("boat"), 3u);
  EXPECT_THAT(Apply(settings, UnixNow() + 200.0).removed,
              ElementsAre(Pair(Pair(RemovedKind::kWindowChunk, RemovalReason::kAge), 3)));
  EXPECT_EQ(ChunksOf("boat"), 0u);
  EXPECT_THAT(Revisions("boat"), ElementsAre(3, 4));
  EXPECT_THAT(DiagnosisTimes(), ElementsAre(995.0));
}

TEST_P(StoreRetentionTest, KeepsWindowsWhoseAgeIsNotKnown) {
  SaveChunks("boat", 2);
  storage_.Open(WindowsSchema())->Execute("UPDATE chunks SET saved_unix_s = NULL");
  RetentionSettings settings = KeepAll();
  settings.window_age_s = 10.0;
  Apply(settings, 1e12);
  EXPECT_EQ(ChunksOf("boat"), 2u);
}

TEST_P(StoreRetentionTest, RemovesTheOldestUntilTheStoreFits) {
  SaveChunks("former", 20, 20'000);
  SaveChunks("boat", 4, 20'000);
  RetentionSettings settings = KeepAll();
  const std::int64_t whole = Apply(settings).UsedBytes();
  settings.store_bytes = static_cast<std::size_t>(whole) / 2;
  const RetentionPass pass = Apply(settings);
  EXPECT_FALSE(pass.over_limit);
  EXPECT_LE(pass.UsedBytes(), static_cast<std::int64_t>(settings.store_bytes));
  EXPECT_EQ(ChunksOf("boat"), 4u);
}

TEST_P(StoreRetentionTest, RemovesDiagnosesBeforeModelsAndNeitherTheLastNorTheNewest) {
  SaveModels("boat", std::vector<double>(190, 3.0));
  SaveModels("another", std::vector<double>(190, 2.0));
  SaveDiagnoses({1.0, 2.0, 3.0});
  SaveChunks("boat", 3);
  RequestJournal journal(storage_);
  IdentifyRequest request;
  request.correlation_id = "unanswered";
  request.vehicle_id = "boat";
  journal.Keep(AnyRequest(request), {});
  RetentionSettings settings = KeepAll();
  const std::int64_t whole = Apply(settings).UsedBytes();
  settings.store_bytes = static_cast<std::size_t>(whole * 7 / 10);
  EXPECT_FALSE(Apply(settings).over_limit);
  EXPECT_THAT(DiagnosisTimes(), ElementsAre(3.0));
  EXPECT_LT(Revisions("another").size(), 190u);
  EXPECT_EQ(Revisions("boat").size(), 190u);

  settings.store_bytes = 1;
  const RetentionPass pass = Apply(settings);
  EXPECT_TRUE(pass.over_limit);
  EXPECT_GT(pass.UsedBytes(), 1);
  EXPECT_THAT(Revisions("boat"), ElementsAre(189, 190));
  EXPECT_THAT(Revisions("another"), ElementsAre(189, 190));
  EXPECT_THAT(DiagnosisTimes(), ElementsAre(3.0));
  EXPECT_EQ(ChunksOf("boat"), 3u);
  EXPECT_EQ(RequestJournal(storage_).TakeUnanswered().size(), 1u);
}

/// Another daemon may serve the boat.
TEST(PostgresStoreRetention, RemovesOfTheSlicesThatThisDaemonHolds) {
  EngineStorage engine(Engine::kPostgres);
  Identification model = MadeUpIdentification();
  {
    ModelStore store(engine.Storage());
    for (const char* vehicle_id : {"boat-1", "boat-2"}) {
      model.vehicle_id = vehicle_id;
      for (const double unix_s : {1.0, 2.0, 3.0}) store.Save(model, unix_s, {}, kSound);
    }
  }
  ASSERT_NE(SliceOf("boat-1"), SliceOf("boat-2"));
  const telltale::Storage shared(engine.Folder().Path(), engine.Address(),
                                 telltale::Storage::Writes::kNeedLeases);
  shared.Open(SlicesSchema())
      ->Execute("INSERT INTO slices VALUES ($1, 5, 'me', 1e12)", {std::int64_t{SliceOf("boat-1")}});
  shared.held()->Set({{SliceOf("boat-1"), 5}});
  RetentionSettings settings = KeepAll();
  settings.models_per_vehicle = 2;
  StoreRetention(shared, settings, [](const std::string&) { return true; }).Apply(1000.0);
  const ModelStore store(engine.Storage());
  EXPECT_THAT(store.Revisions("boat-1"), ElementsAre(2, 3));
  EXPECT_THAT(store.Revisions("boat-2"), ElementsAre(1, 2, 3));
}

std::uintmax_t BytesOnDisk(const std::filesystem::path& file) {
  return std::filesystem::file_size(file);
}

class SqliteStoreRetention : public ::testing::Test {
 protected:
  void SaveModels(int models) {
    ModelStore store(Storage(folder_.Path()));
    for (int i = 0; i < models; ++i) store.Save(MadeUpIdentification(), i, {}, kSound);
  }

  void KeepTwo() const {
    RetentionSettings settings = KeepAll();
    settings.models_per_vehicle = 2;
    StoreRetention(Storage(folder_.Path()), settings, [](const std::string&) {
      return true;
    }).Apply(1000.0);
  }

  TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_.Path() / "models.sqlite";
};

TEST_F(SqliteStoreRetention, GivesTheSpaceBackToTheDisk) {
  SaveModels(150);
  const auto whole = BytesOnDisk(file_);
  KeepTwo();
  EXPECT_LT(BytesOnDisk(file_), whole / 10);
}

TEST_F(SqliteStoreRetention, GivesTheSpaceBackOfAFileThatKnewNoRetention) {
  SaveModels(150);
  {
    SQLite::Database database(file_, SQLite::OPEN_READWRITE);
    database.exec("PRAGMA auto_vacuum = NONE");
    database.exec("VACUUM");
    ASSERT_EQ(database.execAndGet("PRAGMA auto_vacuum").getInt(), 0);
  }
  const auto whole = BytesOnDisk(file_);
  KeepTwo();
  EXPECT_LT(BytesOnDisk(file_), whole / 10);
  EXPECT_EQ(ModelStore(Storage(folder_.Path())).Revisions(MadeUpIdentification().vehicle_id).size(),
            2u);
}

}  // namespace
}  // namespace telltale
