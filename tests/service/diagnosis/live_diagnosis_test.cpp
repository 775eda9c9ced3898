#include <signal.h>

#include <chrono>
#include <filesystem>
#include <optional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "service/service_fixture.hpp"
#include "support/stable_boat.hpp"
#include "telltale/client/fleet/diagnosis_client.hpp"
#include "telltale/client/fleet/subscriber.hpp"
#include "telltale/client/recording/file_contents.hpp"
#include "telltale/core/data/preparation.hpp"
#include "telltale/core/diagnosis/hypotheses/augmented_identification.hpp"
#include "telltale/core/paper/yellowfish.hpp"
#include "telltale/core/validation/validation.hpp"
#include "telltale/idl/codec/json/model.hpp"
#include "telltale/idl/codec/json/report.hpp"

namespace telltale {
namespace {

using namespace std::chrono_literals;
using ::testing::Contains;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;

class LiveDiagnosis : public ServiceTest {
 protected:
  /// A model of the first five minutes; then minutes in which the propellers give less.
  void SimulateAndWearOut(double thrust_left, double worn_s = 120.0) const {
    Replay(SimulatedRecording(testing::StableBoat(), 0.0, 300.0, 1));
    Run({"identify", "--vehicle-id", kVehicleId, "--out", ModelFile()});
    Replay(SimulatedRecording(Worn(thrust_left), 301.0, worn_s, 2));
  }

  static VesselModel Worn(double thrust_left) {
    VesselModel worn = testing::StableBoat();
    for (std::size_t j = 0; j < 3; ++j) worn.theta[j].tail(4) *= thrust_left;
    return worn;
  }

  /// The model of before the wear.
  std::filesystem::path ModelFile() const { return folder_.Path() / "model.json"; }

  DiagnoseRequest RequestNamed(const std::string& correlation_id) const {
    DiagnoseRequest request;
    request.correlation_id = correlation_id;
    request.vehicle_id = kVehicleId;
    return request;
  }

  /// What one who joins now is given; nothing where none comes within a minute.
  std::optional<PublishedDiagnosis> AwaitDiagnosis() const {
    const Participant participant(domain_.id());
    std::optional<PublishedDiagnosis> published;
    DiagnosisSubscriber diagnoses(
        participant, [&](const PublishedDiagnosis& diagnosis) { published = diagnosis; },
        [](const CodecError& error) { ADD_FAILURE() << error.Message(); });
    const auto deadline = std::chrono::steady_clock::now() + 60s;
    while (!published && std::chrono::steady_clock::now() < deadline) diagnoses.Wait(1s);
    return published;
  }

  static constexpr RequestTiming kTiming{.match = 60s, .reply = 300s, .retry = 1s};
};

TEST_F(LiveDiagnosis, HoldsWhatCameSinceTheModelAgainstItAndPublishes) {
  const auto daemon = StartDaemon();
  SimulateAndWearOut(0.6);
  const auto file = folder_.Path() / "report.json";
  const auto page = folder_.Path() / "report.html";
  const auto diagnose =
      Start({"diagnose", "--vehicle-id", kVehicleId, "--out", file, "--html", page});
  ASSERT_EQ(diagnose->Wait(), 0) << diagnose->output() << daemon->output();
  EXPECT_THAT(diagnose->output(), HasSubstr("Held against revision 1 of yellowfish"));
  const auto text = ReadFile(file);
  ASSERT_TRUE(text);
  const auto report = ParseReportJson(*text);
  ASSERT_TRUE(report) << report.error().Message();
  EXPECT_EQ(report->vehicle_id, kVehicleId);
  EXPECT_NEAR(report->start_s, 301.0, 10.0);
  EXPECT_NEAR(report->end_s, 421.0, 10.0);
  EXPECT_EQ(report->floor_basis, FloorBasis::kReferenceLogs);
  EXPECT_THAT(report->notes, Contains(HasSubstr("behind revision 1")));
  EXPECT_TRUE(std::filesystem::exists(page));

  // Who joins late is given the last diagnosis.
  const auto published = AwaitDiagnosis();
  ASSERT_TRUE(published);
  EXPECT_EQ(published->model_revision, 1u);
  EXPECT_EQ(PrintReportJson(published->diagnosis), *text);
}

/// Of free runs over five seconds, m/s; nothing where the model cannot be read or simulated.
std::optional<double> SurgeErrorOf(const std::filesystem::path& model_file,
                                   const PreparedDataset& simulated) {
  const auto text = ReadFile(model_file);
  const auto identification = text ? ParseModelJson(*text) : Decoded<Identification>();
  if (!identification) return std::nullopt;
  const auto model = AugmentedModelOf(*identification);
  if (!model) return std::nullopt;
  const auto metrics = Validate(simulated, *model, {.horizons_s = {5.0}});
  return metrics ? std::optional(metrics->free_run[0].velocity[0].rmse) : std::nullopt;
}

// On a day that neither model has seen. Half the error gone is far more than chance and far less
// than a right cause closes.
TEST_F(LiveDiagnosis, GivesAModelThatIsTruerOfTheBoatAsItIsNow) {
  const auto daemon = StartDaemon();
  SimulateAndWearOut(0.6);
  const auto better = folder_.Path() / "better.json";
  const auto diagnose = Start({"diagnose", "--vehicle-id", kVehicleId, "--without", "thrust_sag",
                               "--seed", "3", "--out-model", better});
  ASSERT_EQ(diagnose->Wait(), 0) << diagnose->output() << daemon->output();
  const auto simulated = Prepare(SimulatedRecording(Worn(0.6), 0.0, 120.0, 3), YellowfishVehicle(),
                                 PrepareOptions::Robust());
  ASSERT_TRUE(simulated);
  const auto error_before = SurgeErrorOf(ModelFile(), *simulated);
  const auto error_after = SurgeErrorOf(better, *simulated);
  ASSERT_TRUE(error_before);
  ASSERT_TRUE(error_after) << diagnose->output();
  EXPECT_LT(*error_after, 0.5 * *error_before) << diagnose->output();
}

TEST_F(LiveDiagnosis, FailsARequestToLeaveOutAnEffectThereIsNot) {
  const auto daemon = StartDaemon();
  const Participant participant(domain_.id());
  DiagnosisClient client(participant);
  DiagnoseRequest wrong = RequestNamed("no-such-effect");
  wrong.without = {"sea_monster"};
  const auto answer = client.Diagnose(wrong, kTiming);
  ASSERT_EQ(answer.outcome, RequestOutcome::kFailed);
  EXPECT_THAT(answer.reply->message, HasSubstr("sea_monster"));
  EXPECT_FALSE(answer.reply->augmented);
  const auto diagnose = Start({"diagnose", "--vehicle-id", kVehicleId, "--without", "sea_monster"});
  EXPECT_EQ(diagnose->Wait(), 2);
  EXPECT_THAT(diagnose->output(), HasSubstr("no such effect as sea_monster"));
}

TEST_F(LiveDiagnosis, IsFollowedByWatch) {
  const auto daemon = StartDaemon();
  const auto watch = Start({"watch", "--all", "--count", "2", "--timeout", "120"});
  SimulateAndWearOut(0.6);
  Run({"diagnose", "--vehicle-id", kVehicleId});
  EXPECT_EQ(watch->Wait(), 0) << watch->output();
  EXPECT_THAT(watch->output(), HasSubstr("yellowfish, revision 1\n"));
  EXPECT_THAT(watch->output(), ContainsRegex("yellowfish, revision 1 diagnosed: [^\n]*\\.\n$"));
}

TEST_F(LiveDiagnosis, IsPublishedAgainAfterTheDaemonWasKilled) {
  auto daemon = StartDaemon();
  SimulateAndWearOut(0.6);
  const auto file = folder_.Path() / "report.json";
  Run({"diagnose", "--vehicle-id", kVehicleId, "--out", file});
  daemon->Signal(SIGKILL);
  daemon->Wait();
  daemon = StartDaemon();
  const auto published = AwaitDiagnosis();
  ASSERT_TRUE(published) << daemon->output();
  EXPECT_EQ(published->model_revision, 1u);
  EXPECT_EQ(PrintReportJson(published->diagnosis), *ReadFile(file));
  const auto watch = Start({"watch", "--all", "--count", "2", "--timeout", "60", "--json"});
  EXPECT_EQ(watch->Wait(), 0) << watch->output();
  EXPECT_THAT(watch->output(), ContainsRegex("\"modelRevision\": *\"1\""));
  EXPECT_THAT(watch->output(), HasSubstr("\"coefficients\""));
}

TEST_F(LiveDiagnosis, AnswersACorrelationIdOnceAndTellsHowFarItIs) {
  const auto daemon = StartDaemon();
  SimulateAndWearOut(1.0);
  const Participant participant(domain_.id());
  DiagnosisClient client(participant);
  // Once its refusal was heard, the daemon knows this client's reader of progress too.
  DiagnoseRequest refused = RequestNamed("met");
  refused.vehicle_id = "nobody";
  ASSERT_EQ(client.Diagnose(refused, kTiming).outcome, RequestOutcome::kFailed);
  std::vector<std::string> stages;
  const auto first =
      client.Diagnose(RequestNamed("the-same"), kTiming,
                      [&](const DiagnoseProgress& progress) { stages.push_back(progress.stage); });
  const auto again = client.Diagnose(RequestNamed("the-same"), kTiming);
  ASSERT_EQ(first.outcome, RequestOutcome::kPublished) << daemon->output();
  ASSERT_EQ(again.outcome, RequestOutcome::kPublished);
  EXPECT_EQ(again.reply->elapsed_s, first.reply->elapsed_s);
  EXPECT_THAT(stages, Contains("queued"));
}

TEST_F(LiveDiagnosis, IsRefusedWithoutAModelAndWithoutDataOfItsOwn) {
  const auto daemon = StartDaemon();
  const auto unmodelled = Start({"diagnose", "--vehicle-id", kVehicleId});
  EXPECT_EQ(unmodelled->Wait(), 3);
  EXPECT_THAT(unmodelled->output(), HasSubstr("identify it first"));
  ReplaySimulation();
  Run({"identify", "--vehicle-id", kVehicleId});
  const auto same_data = Start({"diagnose", "--vehicle-id", kVehicleId});
  EXPECT_EQ(same_data->Wait(), 3);
  EXPECT_THAT(same_data->output(), HasSubstr("since revision 1"));
  const auto nobody = Start({"diagnose", "--vehicle-id", "nobody"});
  EXPECT_EQ(nobody->Wait(), 1);
  EXPECT_THAT(nobody->output(), HasSubstr("'nobody' is not served here; served: yellowfish"));
}

TEST_F(LiveDiagnosis, IsMissedWhereThereIsNoDaemon) {
  const auto diagnose = Start({"diagnose", "--vehicle-id", kVehicleId, "--timeout", "0.2"});
  EXPECT_EQ(diagnose->Wait(), 1);
  EXPECT_THAT(diagnose->output(), HasSubstr("is telltaled running on domain"));
}

// The propellers give almost nothing any more: the model keeps predicting that they do.
TEST_F(LiveDiagnosis, IsProposedWhereTheModelNoLongerFits) {
  const auto daemon = StartDaemon();
  SimulateAndWearOut(0.1, 600.0);  // five minutes have to be of the worn boat
  const auto quality =
      AwaitQuality(kVehicleId, [](const Quality& q) { return !q.drift_evidence.empty(); });
  ASSERT_TRUE(quality) << daemon->output();
  EXPECT_EQ(quality->proposal, "telltale diagnose --vehicle-id yellowfish asks why");
  EXPECT_TRUE(daemon->WaitForOutput("telltale diagnose --vehicle-id yellowfish asks why"));
  const auto monitor = Start({"monitor", "--once"});
  EXPECT_EQ(monitor->Wait(), 0);
  // The monitor wraps its lines.
  EXPECT_THAT(monitor->output(), ContainsRegex("diagnose[[:space:]]+--vehicle-id yellowfish"));
  Run({"diagnose", "--vehicle-id", kVehicleId});
  const auto answered = AwaitQuality(
      kVehicleId, [](const Quality& q) { return q.proposal.starts_with("the diagnosis finds "); });
  ASSERT_TRUE(answered) << daemon->output();
  EXPECT_EQ(answered->drift_evidence.find("telltale"), std::string::npos);
}

}  // namespace
}  // namespace telltale
