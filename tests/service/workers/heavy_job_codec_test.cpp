#include "telltale/service/workers/heavy_job_codec.hpp"

#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/made_up_diagnoses.hpp"
#include "support/made_up_identifications.hpp"
#include "telltale/core/paper/yellowfish.hpp"
#include "telltale/idl/codec/json/model.hpp"
#include "telltale/idl/codec/json/report.hpp"
#include "telltale/idl/codec/vehicle_file.hpp"
#include "telltale/service/windows/window_chunk.hpp"

namespace telltale {
namespace {

using ::testing::HasSubstr;

Vehicle SomeVehicle() {
  Vehicle vehicle = YellowfishVehicle();
  vehicle.vehicle_id = "made-up.1";
  return vehicle;
}

/// A different number in every place.
Recording SomeRecording(double start_s) {
  Recording recording;
  recording.gnss = {{start_s, 54.1, 10.2}, {start_s + 0.2, 54.25, -10.3}};
  recording.heading = {{start_s + 0.1, 359.5}};
  recording.thrusters = {{start_s + 0.3, 1500.0, 1625.5}};
  recording.starts_s = {start_s, start_s + 0.25};
  return recording;
}

IdentificationTask SomeIdentification() {
  IdentificationTask task;
  task.request.correlation_id = "one";
  task.request.vehicle_id = "made-up.1";
  task.request.seed = 77;
  task.request.estimator = Estimator::kWeakIv;
  task.request.coverage_check_replicates = 40;
  task.settings.structure = Structure::kFirstOrderDynamic;
  task.settings.bootstrap_replicates = 300;
  task.settings.interval_level = 0.9;
  task.vehicle = SomeVehicle();
  task.recording = SomeRecording(100.0);
  return task;
}

DiagnosisTask SomeDiagnosis() {
  DiagnosisTask task;
  task.request.correlation_id = "two";
  task.request.vehicle_id = "made-up.1";
  task.request.refit = true;
  task.request.without = {"wind"};
  task.request.seed = 78;
  task.vehicle = SomeVehicle();
  task.model = MadeUpIdentification();
  task.since = SomeRecording(200.0);
  task.baseline = SomeRecording(20.0);
  return task;
}

void ExpectTheSame(const Recording& one, const Recording& other) {
  EXPECT_EQ(PackChunk(one), PackChunk(other));
  EXPECT_EQ(one.starts_s, other.starts_s);
}

TEST(HeavyJobCodec, GivesAWorkerTheIdentificationThatTheDaemonHas) {
  const IdentificationTask sent = SomeIdentification();
  const auto read = UnpackTask(PackTask(sent));
  ASSERT_TRUE(read) << read.error().Message();
  const auto& task = std::get<IdentificationTask>(*read);
  EXPECT_EQ(task.request, sent.request);
  EXPECT_EQ(task.settings.structure, sent.settings.structure);
  EXPECT_EQ(task.settings.bootstrap_replicates, sent.settings.bootstrap_replicates);
  EXPECT_EQ(task.settings.interval_level, sent.settings.interval_level);
  EXPECT_EQ(PrintVehicle(task.vehicle), PrintVehicle(sent.vehicle));
  ExpectTheSame(task.recording, sent.recording);
}

TEST(HeavyJobCodec, GivesAWorkerTheDiagnosisThatTheDaemonHas) {
  DiagnosisTask sent = SomeDiagnosis();
  const auto read = UnpackTask(PackTask(sent));
  ASSERT_TRUE(read) << read.error().Message();
  const auto& task = std::get<DiagnosisTask>(*read);
  EXPECT_EQ(task.request, sent.request);
  EXPECT_EQ(PrintModelJson(task.model), PrintModelJson(sent.model));
  ExpectTheSame(task.since, sent.since);
  ASSERT_TRUE(task.baseline);
  ExpectTheSame(*task.baseline, *sent.baseline);

  sent.baseline.reset();
  const auto without = UnpackTask(PackTask(sent));
  ASSERT_TRUE(without);
  EXPECT_FALSE(std::get<DiagnosisTask>(*without).baseline);
}

TEST(HeavyJobCodec, LeavesTheDeadlineToTheDaemon) {
  IdentificationTask sent = SomeIdentification();
  sent.request.deadline_s = 5.0;
  const auto read = UnpackTask(PackTask(sent));
  ASSERT_TRUE(read);
  EXPECT_EQ(std::get<IdentificationTask>(*read).request.deadline_s, 0.0);
}

TEST(HeavyJobCodec, RefusesATaskOfWhichABitHasChanged) {
  const std::string blob = PackTask(SomeIdentification());
  for (std::size_t at = 0; at < blob.size(); at += 7) {
    std::string damaged = blob;
    damaged[at] = static_cast<char>(damaged[at] ^ 4);
    EXPECT_FALSE(UnpackTask(damaged)) << at;
  }
  EXPECT_FALSE(UnpackTask(""));
  EXPECT_FALSE(UnpackTask(PackFailure("no task")));
}

TEST(HeavyJobCodec, GivesTheDaemonWhatTheWorkerHasMade) {
  const AssessedModel made{MadeUpIdentification(),
                           {PromotionVerdict::kWarn, "predicts sway no better"},
                           FreeRunError{0.1, 0.2, 0.3}};
  const auto read = UnpackOutcome(PackOutcome(Result<AssessedModel>(made)), IdentificationTask());
  ASSERT_TRUE(read);
  EXPECT_EQ(PrintModelJson(read->identification), PrintModelJson(made.identification));
  EXPECT_EQ(read->promotion, made.promotion);
  EXPECT_EQ(read->reference_error, made.reference_error);

  const DiagnosedModel diagnosed{MadeUpDiagnosis(), MadeUpIdentification()};
  const auto report =
      UnpackOutcome(PackOutcome(Result<DiagnosedModel>(diagnosed)), DiagnosisTask());
  ASSERT_TRUE(report);
  EXPECT_EQ(PrintReportJson(report->diagnosis), PrintReportJson(diagnosed.diagnosis));
  ASSERT_TRUE(report->augmented);
  EXPECT_EQ(PrintModelJson(*report->augmented), PrintModelJson(*diagnosed.augmented));
}

TEST(HeavyJobCodec, GivesTheDaemonWhyThereIsNothing) {
  const Refusal refusal{"sway", "is not excited", "record a zigzag"};
  const auto refused = UnpackOutcome(PackOutcome(Result<AssessedModel>(tl::unexpected(refusal))),
                                     IdentificationTask());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error(), refusal);
  try {
    (void)UnpackOutcome(PackFailure("out of memory"), DiagnosisTask());
    ADD_FAILURE() << "a failure is no outcome";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "out of memory");
  }
  EXPECT_THROW((void)UnpackOutcome("garbage", DiagnosisTask()), std::runtime_error);
  EXPECT_THROW(
      (void)UnpackOutcome(
          PackOutcome(Result<AssessedModel>(AssessedModel{MadeUpIdentification(), {}, {}})),
          DiagnosisTask()),
      std::runtime_error);
}

}  // namespace
}  // namespace telltale
