#include <signal.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "service/service_fixture.hpp"
#include "service/standby/daemon_pair.hpp"
#include "support/stable_boat.hpp"
#include "telltale/client/fleet/diagnosis_client.hpp"
#include "telltale/client/fleet/fleet_client.hpp"
#include "telltale/client/fleet/identification_client.hpp"
#include "telltale/client/fleet/subscriber.hpp"
#include "telltale/service/diagnosis/diagnosis_store.hpp"
#include "telltale/service/models/model_store.hpp"

namespace telltale {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::Not;

/// Two daemons, and a client that has followed the models from the start.
class StandbyDaemon : public ServiceTest {
 protected:
  void StartPair() {
    one_ = pair_.Start("one", 2);
    ASSERT_TRUE(DaemonPair::TakesOver(*one_, 1)) << one_->output();
    two_ = pair_.Start("two", 1);
    ASSERT_TRUE(DaemonPair::StandsBy(*two_, 1)) << two_->output();
  }

  void ReplayToBoth(double duration_s = 300.0) {
    Replay(SimulatedRecording(testing::StableBoat(), 0.0, duration_s, 4));
  }

  /// The revision that the service gives the boat's next model; 0 where it gives none.
  std::uint64_t Identify(const std::string& correlation_id) {
    IdentificationClient client(participant_);
    IdentifyRequest request = Request(correlation_id);
    request.estimator = Estimator::kOneStep;
    request.seed = ++seed_;  // unlike any other, so that it joins none
    const auto result = client.Identify(request, kTiming, {});
    const bool published = result.outcome == RequestOutcome::kPublished;
    return published ? result.reply->model->revision : 0;
  }

  /// When the diagnosis was published; 0 where there is none.
  double Diagnose(const std::string& correlation_id) {
    DiagnoseRequest request;
    request.correlation_id = correlation_id;
    request.vehicle_id = kVehicleId;
    request.seed = ++seed_;  // unlike any other, so that it joins none
    const auto result = DiagnosisClient(participant_).Diagnose(request, kTiming, {});
    const bool published = result.reply && result.reply->diagnosis;
    return published ? result.reply->diagnosis->published_unix_s : 0.0;
  }

  void KillTheFirstOnceBothHaveAModel() {
    StartPair();
    ReplayToBoth();
    ASSERT_EQ(Identify("first"), 1u);
    ASSERT_TRUE(DaemonPair::Keeps(*two_, 1));
    one_->Signal(SIGKILL);
    one_->Wait();
  }

  /// Which revisions the topic of models has brought so far, in their order.
  const std::vector<std::uint64_t>& RevisionsSeen() {
    while (models_.Wait(200ms)) {
    }
    return revisions_;
  }

  /// Those of the daemon that serves, newest first.
  std::vector<std::uint64_t> RevisionsKept() {
    FleetRequest request;
    request.correlation_id = NewCorrelationId();
    request.command = FleetCommand::kHistory;
    request.vehicle_ids = {kVehicleId};
    const auto result = FleetClient(participant_).Ask(request, kTiming);
    std::vector<std::uint64_t> revisions;
    if (!result.reply) return revisions;
    for (const ModelSummary& model : result.reply->models) revisions.push_back(model.revision);
    return revisions;
  }

  static constexpr RequestTiming kTiming{.match = 60s, .reply = 120s, .retry = 1s};

  DaemonPair pair_{domain_.id(), folder_, 5.0,
                   "identification { bootstrap_replicates: 0 structure: \"static\" }\nwindow { "
                   "save_period_s: 0.2 }\n"};
  std::unique_ptr<Process> one_;
  std::unique_ptr<Process> two_;
  Participant participant_{domain_.id()};
  std::vector<std::uint64_t> revisions_;
  // All that is published: ModelSubscription passes over what is older.
  Subscriber<TopicSubscription<telltale_wire_Model, PublishedModel>, PublishedModel> models_{
      participant_, [this](const PublishedModel& model) { revisions_.push_back(model.revision); },
      [](const CodecError& error) { ADD_FAILURE() << error.Message(); }};
  std::uint64_t seed_ = 0;
};

TEST_F(StandbyDaemon, TakesOverWithAWarmWindowWhenTheOtherIsKilled) {
  ASSERT_NO_FATAL_FAILURE(KillTheFirstOnceBothHaveAModel());
  EXPECT_TRUE(DaemonPair::TakesOver(*two_, 2)) << two_->output();
  // It has what prediction errors are measured against too, which no wire carries.
  EXPECT_TRUE(AwaitQuality(kVehicleId, [](const Quality& quality) {
    return quality.model_revision == 1u && quality.prediction_error > 0.0 &&
           quality.window_s > 299.0;
  }));
  EXPECT_EQ(Identify("second"), 2u);
  const auto& seen = RevisionsSeen();
  EXPECT_TRUE(std::ranges::is_sorted(seen)) << ::testing::PrintToString(seen);
}

TEST_F(StandbyDaemon, AnswersWhatTheOtherHadAcknowledged) {
  StartPair();
  ReplayToBoth(90.0);
  IdentificationClient client(participant_);
  IdentifyRequest request = Request("acknowledged");
  request.structure = Structure::kFossen;  // a second of work
  bool killed = false;
  const auto result = client.Identify(request, kTiming, [&](const IdentifyProgress&) {
    if (std::exchange(killed, true)) return;
    one_->Signal(SIGKILL);
    one_->Wait();
  });
  EXPECT_TRUE(killed);
  EXPECT_EQ(result.outcome, RequestOutcome::kPublished) << two_->output();
  EXPECT_TRUE(two_->WaitForOutput("for acknowledged: PUBLISHED"));
  EXPECT_THAT(one_->output(), Not(HasSubstr("for acknowledged: PUBLISHED")));
}

// Service managers start both again each time, for ever where the request is what ends them.
TEST_F(StandbyDaemon, GivesUpARequestThatHasEndedOneOrTheOtherThreeTimes) {
  using Clock = std::chrono::steady_clock;
  StartPair();
  ReplayToBoth(90.0);
  IdentificationClient client(participant_);
  IdentifyRequest request = Request("deadly");
  request.coverage_check_replicates = 1000;  // minutes of work
  int killed = 0;
  Clock::time_point replaced;
  constexpr RequestTiming kPatient{.match = 60s, .reply = 300s, .retry = 1s};
  const auto result = client.Identify(request, kPatient, [&](const IdentifyProgress& progress) {
    // Reports of the daemon that was killed come late; and the client has to ask again, once a
    // second, so that the other hears of the request.
    if (progress.stage == "queued" || Clock::now() < replaced + 3s) return;
    const bool is_one = killed % 2 == 0;
    auto& killed_daemon = is_one ? one_ : two_;
    killed_daemon->Signal(SIGKILL);
    killed_daemon->Wait();
    const int term = ++killed + 1;
    EXPECT_TRUE(DaemonPair::TakesOver(is_one ? *two_ : *one_, term));
    killed_daemon = pair_.Start(is_one ? "one" : "two", is_one ? 2 : 1);
    EXPECT_TRUE(DaemonPair::StandsBy(*killed_daemon, term)) << killed_daemon->output();
    replaced = Clock::now();
  });
  // One that ended before the other had heard of its work does not count.
  EXPECT_GE(killed, 3);
  ASSERT_EQ(result.outcome, RequestOutcome::kFailed);
  EXPECT_THAT(result.reply->message, HasSubstr("each of the 3 times that"));
}

TEST_F(StandbyDaemon, DoesNotAnswerWhileTheOtherServes) {
  StartPair();
  ReplayToBoth();
  for (const char* id : {"a", "b", "c"}) EXPECT_GT(Identify(id), 0u);
  ASSERT_TRUE(DaemonPair::Keeps(*two_, 3));
  for (Process* daemon : {one_.get(), two_.get()}) {
    daemon->Signal(SIGTERM);
    EXPECT_EQ(daemon->Wait(), 0);
  }
  EXPECT_THAT(one_->output(), HasSubstr("for c: PUBLISHED"));
  EXPECT_THAT(two_->output(), Not(HasSubstr("PUBLISHED")));
}

// The first has kept a revision 2 on disk, and was killed before the topic had it.
TEST_F(StandbyDaemon, GivesUpAModelThatNobodyHasHeardOf) {
  ASSERT_NO_FATAL_FAILURE(KillTheFirstOnceBothHaveAModel());
  {
    ModelStore store(telltale::Storage(folder_.Path() / "state-one"));
    StoredModel unheard = *store.Latest(kVehicleId);
    unheard.model.revision = 2;
    unheard.model.published_unix_s += 0.5;
    store.Keep(unheard);
  }
  ASSERT_EQ(Identify("second"), 2u);
  ASSERT_EQ(Identify("third"), 3u);
  one_ = pair_.Start("one", 2);
  ASSERT_TRUE(DaemonPair::Keeps(*one_, 3)) << one_->output();
  ASSERT_TRUE(DaemonPair::IsComplete(*one_)) << one_->output();
  const auto published = [this](const std::string& name) {
    return ModelStore(telltale::Storage(folder_.Path() / ("state-" + name)))
        .PublishedUnixS(kVehicleId, 2);
  };
  EXPECT_TRUE(published("two"));
  EXPECT_EQ(published("one"), published("two"));
}

TEST_F(StandbyDaemon, LearnsWhatWasPublishedBeforeItServesAgain) {
  ASSERT_NO_FATAL_FAILURE(KillTheFirstOnceBothHaveAModel());
  ASSERT_EQ(Identify("second"), 2u);
  ASSERT_EQ(Identify("third"), 3u);

  one_ = pair_.Start("one", 2);  // its own newest is revision 1
  EXPECT_TRUE(DaemonPair::StandsBy(*one_, 2)) << "the stronger leaves the other in its place";
  EXPECT_TRUE(DaemonPair::Keeps(*one_, 3));
  EXPECT_TRUE(DaemonPair::IsComplete(*one_)) << one_->output();
  two_->Signal(SIGKILL);
  two_->Wait();
  EXPECT_EQ(Identify("fourth"), 4u);
  EXPECT_TRUE(DaemonPair::TakesOver(*one_, 3));
  const auto& seen = RevisionsSeen();
  EXPECT_TRUE(std::ranges::is_sorted(seen)) << ::testing::PrintToString(seen);
  EXPECT_EQ(seen.back(), 4u);
  EXPECT_THAT(RevisionsKept(), ::testing::ElementsAre(4, 3, 2, 1));
}

// Made while there was no other, which is given them when it joins.
TEST_F(StandbyDaemon, HasTheDiagnosesFromBeforeItJoined) {
  one_ = pair_.Start("one", 2);
  ASSERT_TRUE(DaemonPair::TakesOver(*one_, 1)) << one_->output();
  ReplayToBoth();
  ASSERT_EQ(Identify("first"), 1u);
  Replay(SimulatedRecording(testing::StableBoat(), 301.0, 120.0, 5));
  const std::vector<double> published_unix_s = {Diagnose("one"), Diagnose("two")};
  two_ = pair_.Start("two", 1);
  ASSERT_TRUE(two_->WaitForOutput("the diagnoses of yellowfish are as complete")) << two_->output();
  two_->Signal(SIGTERM);
  EXPECT_EQ(two_->Wait(), 0);
  const DiagnosisStore store(telltale::Storage(folder_.Path() / "state-two"));
  std::vector<double> kept;
  for (const PublishedDiagnosis& diagnosis : store.History(kVehicleId)) {
    kept.push_back(diagnosis.published_unix_s);
  }
  EXPECT_THAT(kept, ::testing::ElementsAre(published_unix_s[1], published_unix_s[0]));
}

// After a loss of power, say. The stronger one lacks the newest model.
TEST_F(StandbyDaemon, ServesWhereItServedLastAndBothStartAgain) {
  ASSERT_NO_FATAL_FAILURE(KillTheFirstOnceBothHaveAModel());
  ASSERT_EQ(Identify("second"), 2u);
  two_->Signal(SIGKILL);
  two_->Wait();
  two_ = pair_.Start("two", 1);
  one_ = pair_.Start("one", 2);
  EXPECT_TRUE(DaemonPair::TakesOver(*two_, 3)) << two_->output();
  EXPECT_TRUE(DaemonPair::StandsBy(*one_, 3)) << one_->output();
  EXPECT_TRUE(DaemonPair::Keeps(*one_, 2)) << one_->output();
}

// It hangs, or its machine does.
TEST_F(StandbyDaemon, ReplacesADaemonThatIsSuspendedAndTakesItBackAsStandby) {
  StartPair();
  ReplayToBoth();
  ASSERT_EQ(Identify("first"), 1u);
  ASSERT_TRUE(DaemonPair::Keeps(*two_, 1));
  one_->Suspend();
  EXPECT_EQ(Identify("second"), 2u);
  one_->Resume();
  EXPECT_TRUE(one_->WaitForOutput("another daemon serves; this one starts again as its standby"));
  EXPECT_TRUE(DaemonPair::StandsBy(*one_, 2));
  EXPECT_TRUE(DaemonPair::Keeps(*one_, 2));
  EXPECT_EQ(Identify("third"), 3u);
  EXPECT_TRUE(DaemonPair::Keeps(*one_, 3));
  const auto& seen = RevisionsSeen();
  EXPECT_TRUE(std::ranges::is_sorted(seen)) << ::testing::PrintToString(seen);
  one_->Signal(SIGTERM);
  EXPECT_EQ(one_->Wait(), 0);
  EXPECT_THAT(one_->output(), Not(HasSubstr("for second: PUBLISHED")));
  EXPECT_THAT(one_->output(), Not(HasSubstr("for third: PUBLISHED")));
}

// Both would publish the same telemetry otherwise.
TEST_F(StandbyDaemon, RunsItsSourcesOnlyOnceItServes) {
  const std::string source = "source mavlink serial:/dev/no-such-line:57600 fails";
  const DaemonPair pair(domain_.id(), folder_, 5.0,
                        "sources { mavlink { address: \"serial:/dev/no-such-line:57600\" } }\n");
  const auto one = pair.Start("one", 2);
  ASSERT_TRUE(one->WaitForOutput(source)) << one->output();
  const auto two = pair.Start("two", 1);
  ASSERT_TRUE(DaemonPair::StandsBy(*two, 1)) << two->output();
  one->Signal(SIGKILL);
  one->Wait();
  ASSERT_TRUE(DaemonPair::TakesOver(*two, 2)) << two->output();
  ASSERT_TRUE(two->WaitForOutput(source)) << two->output();
  EXPECT_GT(two->output().find(source), two->output().find("this daemon serves from now on"));
}

// It says that it goes.
TEST_F(StandbyDaemon, TakesOverBeforeTheLeaseEndsFromADaemonThatIsStopped) {
  StartPair();
  one_->Signal(SIGTERM);
  EXPECT_EQ(one_->Wait(), 0);
  EXPECT_TRUE(DaemonPair::TakesOver(*two_, 2)) << two_->output();
  EXPECT_EQ(Start({"list"})->Wait(), 0);
}

}  // namespace
}  // namespace telltale
