// The rooms of the service one by one, without the bus.
#include <cmath>
#include <thread>

#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/made_up_diagnoses.hpp"
#include "support/made_up_identifications.hpp"
#include "support/special_values.hpp"
#include "support/stable_boat.hpp"
#include "support/temporary_folder.hpp"
#include "telltale/core/paper/yellowfish.hpp"
#include "telltale/idl/codec/json/model.hpp"
#include "telltale/idl/codec/json/report.hpp"
#include "telltale/service/diagnosis/baseline_recordings.hpp"
#include "telltale/service/diagnosis/diagnosis_recordings.hpp"
#include "telltale/service/diagnosis/diagnosis_store.hpp"
#include "telltale/service/identification/identification_jobs.hpp"
#include "telltale/service/ingest/fleet.hpp"
#include "telltale/service/ingest/sequence_gaps.hpp"
#include "telltale/service/ingest/vehicle_window.hpp"
#include "telltale/service/models/model_store.hpp"
#include "telltale/service/models/predecessor.hpp"
#include "telltale/service/monitoring/drift_detector.hpp"
#include "telltale/service/monitoring/live_estimator.hpp"
#include "telltale/service/monitoring/prediction_error.hpp"

namespace telltale {
namespace {

template <class Sample>
std::vector<Sample> Before(const std::vector<Sample>& samples, double end_s) {
  std::vector<Sample> before = samples;
  std::erase_if(before, [&](const Sample& sample) { return sample.time_s > end_s; });
  return before;
}

Recording Before(const Recording& recording, double end_s) {
  return {Before(recording.gnss, end_s), Before(recording.heading, end_s),
          Before(recording.thrusters, end_s), recording.rejected};
}

SequenceGaps Gaps(std::initializer_list<std::uint64_t> sequence_numbers) {
  SequenceGaps gaps;
  for (const auto number : sequence_numbers) gaps.Note(number);
  return gaps;
}

TEST(SequenceGaps, CountsWhatIsMissingBetweenSamples) {
  EXPECT_EQ(Gaps({1, 2, 3}).lost(), 0u);
  EXPECT_EQ(Gaps({1, 2, 6, 7, 9}).lost(), 4u);
}

TEST(SequenceGaps, BeginsWhereverItJoins) {
  EXPECT_EQ(Gaps({500, 501}).lost(), 0u);
}

TEST(SequenceGaps, TakesABoatThatStartsAnewForThat) {
  EXPECT_EQ(Gaps({7, 8, 1, 2, 4}).lost(), 1u);
  EXPECT_EQ(Gaps({1, 2, std::uint64_t{1} << 60}).lost(), 0u);
}

TEST(VehicleWindow, CountsArrivalsAdmissionsAndLoss) {
  VehicleWindow window(YellowfishVehicle(), WindowLimits());
  window.Add(1, GnssFix{0.0, 37.0, -6.0});
  window.Add(4, GnssFix{60.0, 37.1, -6.0});
  window.Add(1, HeadingSample{30.0, std::nan("")});
  const WindowState state = window.State();
  EXPECT_EQ(state.arrived[0], 2u);
  EXPECT_EQ(state.arrived[1], 1u);
  EXPECT_EQ(state.accepted, 2u);
  EXPECT_EQ(state.lost, 2u);
  EXPECT_EQ(state.rejected.Of(Channel::kHeading, RejectReason::kNotFinite), 1u);
  EXPECT_DOUBLE_EQ(state.fill, 60.0 / WindowLimits().duration_s);
  EXPECT_EQ(window.Snapshot().gnss.size(), 2u);
}

TEST(VehicleWindow, LosesNothingBetweenThreads) {
  VehicleWindow window(YellowfishVehicle(), WindowLimits());
  constexpr std::uint64_t kSamples = 20000;
  std::jthread reader([&](const std::stop_token& stop) {
    while (!stop.stop_requested()) window.Snapshot();
  });
  for (std::uint64_t i = 1; i <= kSamples; ++i) {
    const double time_s = 0.01 * static_cast<double>(i);
    window.Add(i, HeadingSample{time_s, std::fmod(time_s, 360.0)});
  }
  reader.request_stop();
  reader.join();
  EXPECT_EQ(window.State().accepted, kSamples);
  EXPECT_EQ(window.State().lost, 0u);
}

TEST(Fleet, FindsItsVehiclesAndCountsTheRest) {
  Vehicle one = YellowfishVehicle();
  one.vehicle_id = "one";
  Fleet fleet({one}, WindowLimits());
  ASSERT_NE(fleet.Find("one"), nullptr);
  EXPECT_EQ(fleet.Find("one")->vehicle().vehicle_id, "one");
  EXPECT_EQ(fleet.Find("two"), nullptr);
  fleet.CountUnattributed("gnss", UnattributedReason::kUnknownVehicle);
  fleet.CountUnattributed("gnss", UnattributedReason::kUnknownVehicle);
  EXPECT_EQ(fleet.Unattributed(), (std::vector<RejectEntry>{{"gnss", "UNKNOWN_VEHICLE", 2}}));
}

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

TEST_F(ModelStoreTest, RefusesAStoreOfALaterProgram) {
  { ModelStore store(folder_.Path()); }
  SQLite::Database(folder_.Path() / "models.sqlite", SQLite::OPEN_READWRITE)
      .exec("PRAGMA user_version = 99");
  EXPECT_THROW(ModelStore(folder_.Path()), SQLite::Exception);
}

class PredecessorTest : public ModelStoreTest {
 protected:
  PredecessorTest() {
    model_ = IdentificationByHand();
    model_.provenance = {};
  }

  Identification Over(double start_s) {
    model_.window.start_s = start_s;
    model_.window.end_s = start_s + 600.0;
    return model_;
  }

  ModelStore store_{folder_.Path()};
};

TEST_F(PredecessorTest, AFirstModelHasNone) {
  EXPECT_FALSE(ChangeSincePredecessor(store_, Over(0.0)));
}

TEST_F(PredecessorTest, IsTheNewestThatSharesNoData) {
  store_.Save(Over(0.0), 1.0, std::nullopt);
  store_.Save(Over(500.0), 2.0, std::nullopt);
  store_.Save(Over(900.0), 3.0, std::nullopt);
  const auto change = ChangeSincePredecessor(store_, Over(1100.0));
  ASSERT_TRUE(change);
  EXPECT_EQ(change->revision, 2u);
  EXPECT_EQ(change->verdict, ChangeVerdict::kNoSignificantChange);
  EXPECT_EQ(change->coefficients.size(), 5u);
}

TEST_F(PredecessorTest, ThatWasMadeAlike) {
  store_.Save(Over(0.0), 1.0, std::nullopt);
  model_.sampling_period_s = 1.0;
  store_.Save(Over(1000.0), 2.0, std::nullopt);
  model_.sampling_period_s = 0.2;
  model_.coefficients[7].estimate += 100.0;
  const auto change = ChangeSincePredecessor(store_, Over(2000.0));
  EXPECT_EQ(change->revision, 1u);
  EXPECT_EQ(change->verdict, ChangeVerdict::kChanged);
  EXPECT_EQ(change->coefficients[0].regressor, "r:d^2");
}

TEST_F(PredecessorTest, ItCannotBeToldFromModelsOfTheSameData) {
  store_.Save(Over(0.0), 1.0, std::nullopt);
  const auto change = ChangeSincePredecessor(store_, Over(599.0));
  ASSERT_TRUE(change);
  EXPECT_EQ(change->verdict, ChangeVerdict::kInconclusive);
  EXPECT_EQ(change->revision, 0u);
  EXPECT_NE(change->reason.find("share data"), std::string::npos);
}

TEST_F(PredecessorTest, ItCannotBeToldFromTooFewClusters) {
  model_.provenance.clusters = 10;
  store_.Save(Over(0.0), 1.0, std::nullopt);
  const auto change = ChangeSincePredecessor(store_, Over(600.0));
  EXPECT_EQ(change->verdict, ChangeVerdict::kInconclusive);
  EXPECT_EQ(change->revision, 1u);
}

TEST(PredictionError, IsOneWhereNothingChangedAndScalesWithTheError) {
  const FreeRunError reference{0.1, 0.2, 0.3};
  EXPECT_DOUBLE_EQ(RelativeError(reference, reference), 1.0);
  EXPECT_DOUBLE_EQ(RelativeError({0.3, 0.6, 0.9}, reference), 3.0);
  EXPECT_DOUBLE_EQ(RelativeError({0.2, 0.2, 0.3}, reference), std::sqrt(2.0));
}

/// Rows of a whole recording taken in piece by piece are those of the recording taken at once but
/// for what interpolation makes of the ends of pieces: a hundredth of an error bar, five allowed.
TEST(LiveEstimator, TellsTheSameHoweverItIsFed) {
  const Recording recording =
      testing::SimulateStableBoat(testing::StableBoat(), 300.0, SensorOptions(), 5);
  LiveEstimator at_once;
  at_once.Update(recording, testing::StableBoatVehicle());
  LiveEstimator by_pieces;
  for (double end_s = 10.0; end_s <= 300.0; end_s += 7.0) {
    const Recording until = Before(recording, end_s);
    if (by_pieces.IsDue(end_s)) by_pieces.Update(until, testing::StableBoatVehicle());
  }
  by_pieces.Update(recording, testing::StableBoatVehicle());
  EXPECT_EQ(by_pieces.rows(), at_once.rows());
  const auto one = at_once.Estimates();
  const auto other = by_pieces.Estimates();
  ASSERT_EQ(one.size(), 35u);
  ASSERT_EQ(other.size(), 35u);
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_NEAR(one[i].estimate, other[i].estimate, 0.05 * one[i].standard_error);
  }
}

TEST(LiveEstimator, IsDueAfterSomeSecondsOrANewClock) {
  LiveEstimator feed;
  EXPECT_FALSE(feed.IsDue(4.0));
  feed.Update(testing::SimulateStableBoat(testing::StableBoat(), 60.0, SensorOptions(), 5),
              testing::StableBoatVehicle());
  EXPECT_FALSE(feed.IsDue(62.0));
  EXPECT_TRUE(feed.IsDue(65.0));
  EXPECT_TRUE(feed.IsDue(3.0));
}

// ---- diagnoses on disk
// ---------------------------------------------------------------------------

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

// ---- what a live diagnosis is about -------------------------------------------------------------

/// A fix a second of [start_s, end_s].
Recording FixesOf(double start_s, double end_s) {
  Recording recording;
  for (double t = start_s; t <= end_s; t += 1.0) recording.gnss.push_back({t, 0.0, 0.0});
  return recording;
}

PublishedModel ModelMadeOf(double start_s, double end_s) {
  PublishedModel model{MadeUpIdentification(), 3, 0.0};
  model.identification.window.start_s = start_s;
  model.identification.window.end_s = end_s;
  return model;
}

TEST(DiagnosisRecordings, IsWhatCameSinceTheModelAgainstWhatMadeIt) {
  const auto live =
      SelectDiagnosisRecordings(FixesOf(0.0, 500.0), ModelMadeOf(100.0, 400.0), std::nullopt);
  ASSERT_TRUE(live);
  EXPECT_EQ(live->since.gnss.front().time_s, 401.0);
  EXPECT_EQ(live->since.gnss.back().time_s, 500.0);
  ASSERT_TRUE(live->baseline);
  EXPECT_EQ(live->baseline->gnss.front().time_s, 100.0);
  EXPECT_EQ(live->baseline->gnss.back().time_s, 400.0);
  EXPECT_NE(live->basis.find("300 s behind revision 3"), std::string::npos) << live->basis;
}

TEST(DiagnosisRecordings, TakesTheRecordingBehindTheModelWhereItIsAtHand) {
  const auto live = SelectDiagnosisRecordings(FixesOf(4000.0, 4500.0), ModelMadeOf(100.0, 400.0),
                                              FixesOf(100.0, 400.0));
  ASSERT_TRUE(live);
  EXPECT_EQ(live->since.gnss.size(), 501u);
  ASSERT_TRUE(live->baseline);
  EXPECT_EQ(live->baseline->gnss.size(), 301u);
}

TEST(DiagnosisRecordings, SaysWhereNoBaselineIsAtHand) {
  const auto live =
      SelectDiagnosisRecordings(FixesOf(390.0, 500.0), ModelMadeOf(100.0, 400.0), std::nullopt);
  ASSERT_TRUE(live);
  EXPECT_FALSE(live->baseline);
  EXPECT_NE(live->basis.find("no longer held"), std::string::npos) << live->basis;
}

TEST(DiagnosisRecordings, AWindowThatEndsBeforeTheModelsDataIsOfAnotherClock) {
  const auto live =
      SelectDiagnosisRecordings(FixesOf(0.0, 100.0), ModelMadeOf(1000.0, 1400.0), std::nullopt);
  ASSERT_TRUE(live);
  EXPECT_EQ(live->since.gnss.size(), 101u);
  EXPECT_FALSE(live->baseline);
}

TEST(DiagnosisRecordings, IsRefusedWhereTooLittleCameSince) {
  for (const double end_s : {400.0, 459.0}) {
    const auto live =
        SelectDiagnosisRecordings(FixesOf(0.0, end_s), ModelMadeOf(100.0, 400.0), std::nullopt);
    ASSERT_FALSE(live);
    EXPECT_NE(live.error().reason.find("revision 3"), std::string::npos);
  }
  EXPECT_FALSE(SelectDiagnosisRecordings(Recording(), ModelMadeOf(100.0, 400.0), std::nullopt));
}

TEST(BaselineRecordings, KeepThatOfTheNewestRevision) {
  BaselineRecordings baseline;
  EXPECT_FALSE(baseline.Behind("boat", 1));
  baseline.Keep("boat", 1, FixesOf(0.0, 9.0));
  baseline.Keep("boat", 2, FixesOf(0.0, 99.0));
  EXPECT_FALSE(baseline.Behind("boat", 1));
  EXPECT_FALSE(baseline.Behind("another", 2));
  ASSERT_TRUE(baseline.Behind("boat", 2));
  EXPECT_EQ(baseline.Behind("boat", 2)->gnss.size(), 100u);
}

/// Evaluations, five seconds apart, until the test fires; none: not within an hour.
std::optional<int> EvaluationsUntilDrift(double relative_error) {
  DriftDetector test;
  for (int i = 1; i <= 720; ++i) {
    test.Add(relative_error);
    if (test.Fires()) return i;
  }
  return std::nullopt;
}

TEST(DriftDetector, FiresTheSoonerTheWorseAndNeverWithinBounds) {
  EXPECT_EQ(EvaluationsUntilDrift(3.0), 16);  // 20 / 1.25
  EXPECT_EQ(EvaluationsUntilDrift(2.0), 80);  // 20 / 0.25
  EXPECT_EQ(EvaluationsUntilDrift(1.75), std::nullopt);
  EXPECT_EQ(EvaluationsUntilDrift(std::nan("")), std::nullopt);
  EXPECT_EQ(EvaluationsUntilDrift(HUGE_VAL), 1);
}

TEST(DriftDetector, OneBadMinuteIsNoDrift) {
  DriftDetector test;
  for (int i = 0; i < 1000; ++i) {
    test.Add(i % 12 == 0 ? 4.0 : 1.0);
    EXPECT_FALSE(test.Fires()) << i;
  }
}

TEST(DriftDetector, EndsOnceTheErrorHasBeenSmallAgain) {
  DriftDetector test;
  for (int i = 0; i < 100; ++i) test.Add(5.0);
  EXPECT_TRUE(test.Fires());
  int until = 0;
  for (; test.Fires() && until < 100; ++until) test.Add(1.0);
  EXPECT_EQ(until, 54);  // 40 / 0.75
}

TEST(IdentificationOptions, AreTheRequestsWishesOverTheDaemonsDefaults) {
  IdentificationSettings settings;
  settings.bootstrap_replicates = 300;
  settings.interval_level = 0.9;
  IdentifyRequest request;
  request.seed = 5;
  IdentifyOptions options = OptionsOf(request, settings);
  EXPECT_EQ(options.bootstrap_replicates, 300u);
  EXPECT_EQ(options.interval_level, 0.9);
  EXPECT_EQ(options.prepare.preset, Preset::kRobust);
  EXPECT_EQ(options.regression.parameterization, Parameterization::kPropeller);
  EXPECT_EQ(options.seed, 5u);
  EXPECT_EQ(options.resampling, Resampling::kSlices);
  EXPECT_EQ(options.interval_method, IntervalMethod::kPercentile);
  request.bootstrap_replicates = 0;
  request.resampling = Resampling::kMovingBlocks;
  request.interval_method = IntervalMethod::kStudentized;
  request.preset = Preset::kPaper;
  request.parameterization = Parameterization::kPaper;
  options = OptionsOf(request, settings);
  EXPECT_EQ(options.bootstrap_replicates, 0u);
  EXPECT_EQ(options.resampling, Resampling::kMovingBlocks);
  EXPECT_EQ(options.interval_method, IntervalMethod::kStudentized);
  EXPECT_EQ(options.prepare.preset, Preset::kPaper);
  EXPECT_EQ(options.regression.parameterization, Parameterization::kPaper);
  EXPECT_EQ(options.dead_zone_source, DeadZoneSource::kGiven);
  request.structure = Structure::kFirstOrderDynamic;
  request.dead_zone_source = DeadZoneSource::kIdentified;
  EXPECT_FALSE(options.regression.include_reverse);
  request.include_reverse = true;
  options = OptionsOf(request, settings);
  EXPECT_TRUE(options.regression.include_reverse);
  EXPECT_EQ(options.regression.structure, Structure::kFirstOrderDynamic);
  EXPECT_EQ(options.dead_zone_source, DeadZoneSource::kIdentified);
}

}  // namespace
}  // namespace telltale
