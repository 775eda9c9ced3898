#include "telltale/service/diagnosis/diagnosis_store.hpp"

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "service/storage_fixture.hpp"
#include "support/made_up_diagnoses.hpp"
#include "support/made_up_identifications.hpp"
#include "support/special_values.hpp"
#include "telltale/idl/codec/json/report.hpp"
#include "telltale/service/models/model_store.hpp"
#include "telltale/service/storage/stores.hpp"

namespace telltale {
namespace {

using namespace std::string_view_literals;

class DiagnosisStoreTest : public StorageTest {
 protected:
  PublishedDiagnosis diagnosis_{MadeUpDiagnosis(), 7, 12.5};
};

INSTANTIATE_TEST_SUITE_P(Engines, DiagnosisStoreTest, kEngines, EngineName);

TEST_P(DiagnosisStoreTest, GivesBackTheLastOfEachVehicleAsItWasSaved) {
  {
    DiagnosisStore store(Storage());
    diagnosis_.diagnosis.vehicle_id = "another";
    store.Save(diagnosis_);
    diagnosis_.diagnosis = MadeUpNominalDiagnosis();
    store.Save(diagnosis_);
    diagnosis_ = {MadeUpDiagnosis(), 8, 13.5};
    diagnosis_.diagnosis.vehicle_id = MadeUpNominalDiagnosis().vehicle_id;
    store.Save(diagnosis_);
  }
  const auto last = DiagnosisStore(Storage()).Last(MadeUpNominalDiagnosis().vehicle_id);
  ASSERT_TRUE(last);
  EXPECT_EQ(last->model_revision, 8u);
  EXPECT_EQ(last->published_unix_s, 13.5);
  EXPECT_EQ(PrintReportJson(last->diagnosis), PrintReportJson(diagnosis_.diagnosis));
  const auto other = DiagnosisStore(Storage()).Last("another");
  ASSERT_TRUE(other);
  EXPECT_EQ(other->model_revision, 7u);
  EXPECT_FALSE(DiagnosisStore(Storage()).Last("stranger"));
}

TEST_P(DiagnosisStoreTest, KeepsTheNewestOfAVehicleInTheirOrder) {
  DiagnosisStore store(Storage());
  const std::string& vehicle_id = diagnosis_.diagnosis.vehicle_id;
  EXPECT_TRUE(store.History(vehicle_id).empty());
  const std::size_t saved = kDiagnosesPerVehicle + 3;
  for (std::size_t i = 1; i <= saved; ++i) {
    diagnosis_.model_revision = i;
    diagnosis_.published_unix_s = 1.0e9 + static_cast<double>(i);
    store.Save(diagnosis_);
    store.Save(diagnosis_);  // as a standby does that hears of it again
  }
  const auto history = DiagnosisStore(Storage()).History(vehicle_id);
  ASSERT_EQ(history.size(), kDiagnosesPerVehicle);
  for (std::size_t i = 0; i < history.size(); ++i) {
    EXPECT_EQ(history[i].model_revision, saved - i);
    EXPECT_EQ(history[i].published_unix_s, 1.0e9 + static_cast<double>(saved - i));
  }
  EXPECT_EQ(PrintReportJson(history.back().diagnosis), PrintReportJson(diagnosis_.diagnosis));
  EXPECT_TRUE(store.History("stranger").empty());
}

// As a standby does that asks for what it has missed.
TEST_P(DiagnosisStoreTest, PutsEarlierOnesInTheirPlace) {
  DiagnosisStore store(Storage());
  const auto save_earlier = [&](double published_unix_s) {
    diagnosis_.published_unix_s = published_unix_s;
    return store.SaveEarlier(diagnosis_);
  };
  const auto times = [&] {
    std::vector<double> published_unix_s;
    for (const PublishedDiagnosis& kept : store.History(diagnosis_.diagnosis.vehicle_id)) {
      published_unix_s.push_back(kept.published_unix_s);
    }
    return published_unix_s;
  };
  EXPECT_TRUE(save_earlier(50.0));
  EXPECT_EQ(times(), (std::vector{50.0})) << "the first is the last too";
  for (const double earlier : {40.0, 20.0, 30.0}) EXPECT_TRUE(save_earlier(earlier));
  for (const double known : {40.0, 50.0}) EXPECT_FALSE(save_earlier(known));
  EXPECT_EQ(times(), (std::vector{50.0, 40.0, 30.0, 20.0}));
  EXPECT_TRUE(save_earlier(60.0));
  EXPECT_EQ(store.Last(diagnosis_.diagnosis.vehicle_id)->published_unix_s, 60.0);
  EXPECT_EQ(times(), (std::vector{60.0, 50.0, 40.0, 30.0, 20.0}));
  for (std::size_t i = 0; i < kDiagnosesPerVehicle; ++i)
    save_earlier(41.0 + 0.1 * static_cast<double>(i));
  EXPECT_EQ(times().size(), kDiagnosesPerVehicle);
  EXPECT_EQ(times().back(), 41.2) << "the oldest are dropped";
}

TEST_P(DiagnosisStoreTest, SharesItsDatabaseWithTheModels) {
  ModelStore models(Storage());
  DiagnosisStore diagnoses(Storage());
  diagnoses.Save(diagnosis_);
  const Identification model = MadeUpIdentification();
  EXPECT_EQ(models.Save(model, 1.0, std::nullopt).model.revision, 1u);
  EXPECT_TRUE(diagnoses.Last(diagnosis_.diagnosis.vehicle_id));
  EXPECT_TRUE(models.Latest(model.vehicle_id));
}

TEST_P(DiagnosisStoreTest, KeepsNothingThatNobodyCouldRead) {
  DiagnosisStore store(Storage());
  store.Save(diagnosis_);
  PublishedDiagnosis wrong = diagnosis_;
  wrong.model_revision = 8;
  wrong.diagnosis.gaps.front().all.before = kNan;
  EXPECT_THROW(store.Save(wrong), std::runtime_error);
  EXPECT_EQ(store.Last(diagnosis_.diagnosis.vehicle_id)->model_revision, 7u);
}

TEST_P(DiagnosisStoreTest, PassesOverWhatCannotBeRead) {
  DiagnosisStore store(Storage());
  const std::string& vehicle_id = diagnosis_.diagnosis.vehicle_id;
  const auto damage = [&](std::string_view report) {
    Storage().Open(ModelsSchema())->Execute("UPDATE diagnoses SET report = $1", {Blob(report)});
  };
  for (const std::string_view report : {"\xff\0\xff"sv, ""sv}) {
    store.Save(diagnosis_);
    damage(report);
    EXPECT_FALSE(store.Last(vehicle_id)) << report.size();
  }
  // The last byte of a finite number: the message can still be read.
  std::string flipped = ToProto(diagnosis_.diagnosis).SerializeAsString();
  flipped.back() = static_cast<char>(flipped.back() ^ 1);
  store.Save(diagnosis_);
  damage(flipped);
  EXPECT_FALSE(store.Last(vehicle_id));
  store.Save(diagnosis_);
  EXPECT_TRUE(store.Last(vehicle_id));
}

}  // namespace
}  // namespace telltale
