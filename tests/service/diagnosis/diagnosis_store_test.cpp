#include "telltale/service/diagnosis/diagnosis_store.hpp"

#include <stdexcept>
#include <string>

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>

#include "support/made_up_diagnoses.hpp"
#include "support/made_up_identifications.hpp"
#include "support/special_values.hpp"
#include "support/temporary_folder.hpp"
#include "telltale/idl/codec/json/report.hpp"
#include "telltale/service/models/model_store.hpp"

namespace telltale {
namespace {

class DiagnosisStoreTest : public ::testing::Test {
 protected:
  TemporaryFolder folder_;
  PublishedDiagnosis diagnosis_{MadeUpDiagnosis(), 7, 12.5};
};

TEST_F(DiagnosisStoreTest, GivesBackTheLastOfEachVehicleAsItWasSaved) {
  {
    DiagnosisStore store(folder_.Path());
    diagnosis_.diagnosis.vehicle_id = "another";
    store.Save(diagnosis_);
    diagnosis_.diagnosis = MadeUpNominalDiagnosis();
    store.Save(diagnosis_);
    diagnosis_ = {MadeUpDiagnosis(), 8, 13.5};
    diagnosis_.diagnosis.vehicle_id = MadeUpNominalDiagnosis().vehicle_id;
    store.Save(diagnosis_);
  }
  const auto last = DiagnosisStore(folder_.Path()).Last(MadeUpNominalDiagnosis().vehicle_id);
  ASSERT_TRUE(last);
  EXPECT_EQ(last->model_revision, 8u);
  EXPECT_EQ(last->published_unix_s, 13.5);
  EXPECT_EQ(PrintReportJson(last->diagnosis), PrintReportJson(diagnosis_.diagnosis));
  const auto other = DiagnosisStore(folder_.Path()).Last("another");
  ASSERT_TRUE(other);
  EXPECT_EQ(other->model_revision, 7u);
  EXPECT_FALSE(DiagnosisStore(folder_.Path()).Last("stranger"));
}

TEST_F(DiagnosisStoreTest, SharesItsDatabaseWithTheModels) {
  ModelStore models(folder_.Path());
  DiagnosisStore diagnoses(folder_.Path());
  diagnoses.Save(diagnosis_);
  const Identification model = MadeUpIdentification();
  EXPECT_EQ(models.Save(model, 1.0, std::nullopt).model.revision, 1u);
  EXPECT_TRUE(diagnoses.Last(diagnosis_.diagnosis.vehicle_id));
  EXPECT_TRUE(models.Latest(model.vehicle_id));
}

TEST_F(DiagnosisStoreTest, KeepsNothingThatNobodyCouldRead) {
  DiagnosisStore store(folder_.Path());
  store.Save(diagnosis_);
  PublishedDiagnosis wrong = diagnosis_;
  wrong.model_revision = 8;
  wrong.diagnosis.gaps.front().all.before = kNan;
  EXPECT_THROW(store.Save(wrong), std::runtime_error);
  EXPECT_EQ(store.Last(diagnosis_.diagnosis.vehicle_id)->model_revision, 7u);
}

TEST_F(DiagnosisStoreTest, PassesOverWhatCannotBeRead) {
  DiagnosisStore store(folder_.Path());
  const std::string& vehicle_id = diagnosis_.diagnosis.vehicle_id;
  for (const char* damage : {"x'ff00ff'", "x''"}) {
    store.Save(diagnosis_);
    SQLite::Database(folder_.Path() / "models.sqlite", SQLite::OPEN_READWRITE)
        .exec(std::string("UPDATE diagnoses SET report = ") + damage);
    EXPECT_FALSE(store.Last(vehicle_id)) << damage;
  }
  store.Save(diagnosis_);
  EXPECT_TRUE(store.Last(vehicle_id));
}

}  // namespace
}  // namespace telltale
