#include <signal.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <optional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "service/repeated_request.hpp"
#include "service/service_fixture.hpp"
#include "support/special_values.hpp"
#include "support/stable_boat.hpp"
#include "telltale/client/bus/reader.hpp"
#include "telltale/client/bus/wait_set.hpp"
#include "telltale/client/bus/writer.hpp"
#include "telltale/client/fleet/fleet_client.hpp"
#include "telltale/client/fleet/identification_client.hpp"
#include "telltale/client/fleet/subscriber.hpp"
#include "telltale/client/fleet/telemetry_publisher.hpp"
#include "telltale/client/recording/file_contents.hpp"
#include "telltale/client/recording/telemetry_log/telemetry_log.hpp"
#include "telltale/core/paper/yellowfish.hpp"
#include "telltale/idl/codec/json/model.hpp"
#include "telltale/idl/codec/wire/telemetry.hpp"

namespace telltale {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

using Daemon = ServiceTest;

double SurgeThrustAtFullAhead(const std::vector<double>& theta) {
  const auto regressors = Regressors(Equation::kSurge, Parameterization::kPropeller);
  double thrust = 0.0;
  for (std::size_t i = 0; i < regressors.size(); ++i) {
    if (regressors[i].name == "f:d^2" || regressors[i].name == "f:d") thrust += theta[i];
  }
  return thrust;
}

TEST_F(Daemon, TurnsReplayedTelemetryIntoAModelWithBounds) {
  const auto daemon = StartDaemon();
  ReplaySimulation();
  const auto file = folder_.Path() / "model.json";
  const auto identify = Start({"identify", "--vehicle-id", kVehicleId, "--out", file});
  ASSERT_EQ(identify->Wait(), 0) << identify->output();
  EXPECT_THAT(identify->output(), HasSubstr("revision 1"));

  const auto text = ReadFile(file);
  ASSERT_TRUE(text);
  const auto model = ParseModelJson(*text);
  ASSERT_TRUE(model) << model.error().Message();
  EXPECT_EQ(model->vehicle_id, kVehicleId);
  std::vector<double> estimated;
  for (const Coefficient& coefficient : model->coefficients) {
    EXPECT_LE(coefficient.interval.lower, coefficient.interval.upper);
    if (coefficient.equation == Equation::kSurge) estimated.push_back(coefficient.estimate);
  }
  const VesselModel twin = YellowfishTwin();
  const Eigen::VectorXd& theta = twin.theta[0];
  const double truth = SurgeThrustAtFullAhead({theta.begin(), theta.end()});
  // One-step least squares attenuates; 25 % is what the demonstration promises.
  EXPECT_NEAR(SurgeThrustAtFullAhead(estimated), truth, 0.25 * std::abs(truth));
}

std::uint64_t AccountedForIn(const Quality& quality) {
  std::uint64_t accounted = quality.accepted + quality.lost;
  for (const RejectEntry& entry : quality.rejected) accounted += entry.count;
  return accounted;
}

TEST_F(Daemon, AccountsForEverySample) {
  const auto daemon = StartDaemon();
  const std::uint64_t sent = SizeOf(SimulatedRecording());
  // Best effort may lose samples, and a loss shows only between two that arrive. Where a busy
  // machine loses some before the first or after the last, which nobody can know of, it is replayed
  // again.
  std::optional<Quality> quality;
  std::uint64_t accounted = 0;
  for (int replays = 0; replays < 3 && !quality; ++replays) {
    const std::uint64_t before = accounted;
    ReplaySimulation();
    quality = AwaitQuality(kVehicleId, [&](const Quality& q) {
      accounted = AccountedForIn(q);
      EXPECT_LE(accounted, before + sent);
      return accounted == before + sent;
    });
  }
  ASSERT_TRUE(quality) << accounted << " of " << sent << " a replay";
  EXPECT_NEAR(quality->window_s, 120.0, 1.0);
  EXPECT_NEAR(quality->window_fill, 0.1, 0.001);
  EXPECT_FALSE(quality->model_revision);
}

TEST_F(Daemon, ReportsTheModelAndHowWellItPredicts) {
  const auto daemon = StartDaemon();
  ReplaySimulation();
  Run({"identify", "--vehicle-id", kVehicleId});
  const auto quality =
      AwaitQuality(kVehicleId, [](const Quality& q) { return q.prediction_error > 0.0; });
  ASSERT_TRUE(quality);
  EXPECT_EQ(quality->model_revision, 1u);
  // The last minute was half of what made the model: it cannot be much worse there than overall.
  EXPECT_LT(quality->prediction_error, 2.0);
  const auto monitor = Start({"monitor", "--once"});
  EXPECT_EQ(monitor->Wait(), 0);
  EXPECT_THAT(monitor->output(), HasSubstr(kVehicleId));
}

// Nobody has asked for a model: the live estimates come of themselves.
TEST_F(Daemon, FollowsABoatWithIndicativeEstimates) {
  const auto daemon = StartDaemon();
  Replay(SimulatedRecording(testing::StableBoat(), 0.0, 300.0, 4));
  // Half of 1500: a busy machine loses some of what comes at sixty times its pace.
  std::uint64_t rows = 0;
  const auto settled = [&](const Quality& q) { return (rows = q.indicative_rows) > 750; };
  const auto quality = AwaitQuality(kVehicleId, settled);
  ASSERT_TRUE(quality) << rows << " rows";
  EXPECT_FALSE(quality->model_revision);
  EXPECT_EQ(quality->indicative.size(), 35u);
  const VesselModel boat = testing::StableBoat();
  double thrust = 0.0;
  for (const IndicativeCoefficient& c : quality->indicative) {
    EXPECT_GT(c.standard_error, 0.0);
    if (c.equation == Equation::kSurge && c.regressor.starts_with("f:")) thrust += c.estimate;
  }
  // Indicative: one-step least squares attenuates.
  EXPECT_NEAR(thrust, boat.theta[0][5] + boat.theta[0][6], 0.25 * 0.7);
  const auto monitor = Start({"monitor", "--once", "--vehicle-id", kVehicleId});
  EXPECT_EQ(monitor->Wait(), 0);
  EXPECT_THAT(monitor->output(), HasSubstr("±"));
}

TEST_F(Daemon, GivesEachBoatAVerdictWithItsReasons) {
  const auto daemon = StartDaemon();
  const auto unheard =
      AwaitQuality(kVehicleId, [](const Quality& q) { return !q.reasons.empty(); });
  ASSERT_TRUE(unheard);
  EXPECT_EQ(unheard->verdict, QualityVerdict::kStale);
  EXPECT_EQ(unheard->reasons.front().code, "NO_TELEMETRY");

  ReplaySimulation();
  const auto is = [](QualityVerdict verdict) {
    return [verdict](const Quality& q) { return q.verdict == verdict; };
  };
  const auto unmodelled = AwaitQuality(kVehicleId, is(QualityVerdict::kWarn));
  ASSERT_TRUE(unmodelled);
  EXPECT_TRUE(unmodelled->position);
  Run({"identify", "--vehicle-id", kVehicleId});
  const auto modelled = AwaitQuality(
      kVehicleId, [](const Quality& q) { return q.model_revision && q.relative_half_width > 0.0; });
  ASSERT_TRUE(modelled);
  EXPECT_GT(modelled->identified, 20u);
  EXPECT_LE(modelled->identified, modelled->coefficients);

  const auto monitor = Start({"monitor", "--json", "--count", "2"});
  EXPECT_EQ(monitor->Wait(), 0);
  EXPECT_EQ(std::ranges::count(monitor->output(), '\n'), 2) << monitor->output();
  EXPECT_THAT(monitor->output(), HasSubstr("\"verdict\":\""));
  const auto stranger = Start({"monitor", "--once", "--vehicle-id", "nobody"});
  EXPECT_EQ(stranger->Wait(), 1);
  EXPECT_THAT(stranger->output(), HasSubstr("served: yellowfish"));
}

/// The daemon's own record of a refusal reaches the monitors.
TEST_F(Daemon, WarnsOfARefusedIdentification) {
  const auto daemon = StartDaemon();
  const auto identify = Start({"identify", "--vehicle-id", kVehicleId});
  EXPECT_EQ(identify->Wait(), 3) << identify->output();
  const auto refused =
      AwaitQuality(kVehicleId, [](const Quality& q) { return q.last_refusal.has_value(); });
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->reasons.back().code, "REFUSED");
}

TEST_F(Daemon, GivesALateJoinerTheLastModel) {
  const auto daemon = StartDaemon();
  ReplaySimulation();
  Run({"identify", "--vehicle-id", kVehicleId});
  Run({"identify", "--vehicle-id", kVehicleId, "--seed", "2"});
  const auto watch =
      Start({"watch", "--vehicle-id", kVehicleId, "--count", "1", "--timeout", "60"});
  EXPECT_EQ(watch->Wait(), 0) << watch->output();
  EXPECT_THAT(watch->output(), HasSubstr("revision 2"));
}

// Three days of one boat; on the third its propellers give a quarter less.
TEST_F(Daemon, TellsWhetherABoatHasChanged) {
  const auto daemon = StartDaemon();
  constexpr double kDayS = 5000.0;  // beyond what a window holds
  VesselModel worn = testing::StableBoat();
  for (std::size_t j = 0; j < 3; ++j) worn.theta[j].tail(4) *= 0.75;
  Replay(SimulatedRecording(testing::StableBoat(), 0.0, 300.0, 1));
  Run({"identify", "--vehicle-id", kVehicleId});
  const auto again = Start({"identify", "--vehicle-id", kVehicleId});
  EXPECT_EQ(again->Wait(), 0) << again->output();
  EXPECT_THAT(again->output(), HasSubstr("cannot be compared"));  // it is the same window

  // The same way and the same noise a day later: which samples a busy machine loses is chance, and
  // of two ways one pair in a hundred rightly differs.
  Replay(SimulatedRecording(testing::StableBoat(), kDayS, 300.0, 1));
  const auto alike = Start({"identify", "--vehicle-id", kVehicleId});
  EXPECT_EQ(alike->Wait(), 0) << alike->output();
  EXPECT_THAT(alike->output(), HasSubstr("no different from revision 2"));

  Replay(SimulatedRecording(worn, 2.0 * kDayS, 300.0, 3));
  const auto file = folder_.Path() / "worn.json";
  Run({"identify", "--vehicle-id", kVehicleId, "--out", file});
  EXPECT_TRUE(daemon->WaitForOutput("revision 4 of yellowfish differs from revision 3"));
  const auto watch = Start({"watch", "--all", "--count", "1", "--timeout", "60"});
  EXPECT_EQ(watch->Wait(), 0) << watch->output();
  EXPECT_THAT(watch->output(), HasSubstr("differs from revision 3: p = "));
  const auto model = ParseModelJson(*ReadFile(file));
  ASSERT_TRUE(model) << model.error().Message();
  ASSERT_TRUE(model->provenance.change);
  EXPECT_EQ(model->provenance.change->verdict, ChangeVerdict::kChanged);
  EXPECT_THAT(model->provenance.change->coefficients[0].regressor, HasSubstr(":d"));
}

// A daemon that is killed between the reply and the note that it is sent answers the request once
// more, so that the first model may be revision 2 too.
TEST_F(Daemon, KeepsModelsThroughBeingKilled) {
  auto daemon = StartDaemon();
  ReplaySimulation();
  Run({"identify", "--vehicle-id", kVehicleId});
  daemon->Signal(SIGKILL);
  daemon->Wait();

  daemon = StartDaemon();
  const auto watch = Start({"watch", "--all", "--count", "1", "--timeout", "60"});
  EXPECT_EQ(watch->Wait(), 0) << watch->output();
  EXPECT_THAT(watch->output(), ::testing::ContainsRegex("revision [12]"));
  ReplaySimulation();
  const auto identify = Start({"identify", "--vehicle-id", kVehicleId});
  EXPECT_EQ(identify->Wait(), 0) << identify->output();
  EXPECT_THAT(identify->output(), ::testing::ContainsRegex("revision [23]"));
}

TEST_F(Daemon, SaysWhichVehiclesItServesWhenAskedForAnother) {
  const auto daemon = StartDaemon();
  const auto identify = Start({"identify", "--vehicle-id", "nobody"});
  EXPECT_EQ(identify->Wait(), 1);
  EXPECT_THAT(identify->output(), HasSubstr("'nobody' is not served here; served: yellowfish"));
}

TEST_F(Daemon, RefusesAnEmptyWindowWithAdvice) {
  const auto daemon = StartDaemon();
  const auto identify = Start({"identify", "--vehicle-id", kVehicleId});
  EXPECT_EQ(identify->Wait(), 3);
  EXPECT_THAT(identify->output(), HasSubstr("the data cannot answer"));
}

TEST_F(Daemon, IsMissedWhenItIsNotThere) {
  const auto identify = Start({"identify", "--vehicle-id", kVehicleId, "--timeout", "0.2"});
  EXPECT_EQ(identify->Wait(), 1);
  EXPECT_THAT(identify->output(), HasSubstr("is telltaled running on domain"));

  WriteTelemetryLog(folder_.Path() / "log", SimulatedRecording());
  const auto replay = Start(
      {"replay", "--log", folder_.Path() / "log", "--vehicle-id", kVehicleId, "--timeout", "0.2"});
  EXPECT_EQ(replay->Wait(), 1);
  EXPECT_THAT(replay->output(), HasSubstr("nobody takes telemetry"));

  const auto monitor = Start({"monitor", "--once", "--timeout", "0.2"});
  EXPECT_EQ(monitor->Wait(), 1);
  const auto watch = Start({"watch", "--all", "--count", "1", "--timeout", "0.2"});
  EXPECT_EQ(watch->Wait(), 1);
}

TEST_F(Daemon, AnswersLateOnceItIsAwakeAgain) {
  const auto daemon = StartDaemon();
  const Participant participant(domain_.id());
  IdentificationClient client(participant);
  RequestTiming timing{.match = 60s, .reply = 60s, .retry = 100ms};
  ASSERT_EQ(client.Identify(Request("first"), timing).outcome, RequestOutcome::kRefused);

  daemon->Suspend();
  timing.reply = 500ms;
  EXPECT_EQ(client.Identify(Request("second"), timing).outcome, RequestOutcome::kTimedOut);
  daemon->Resume();
  timing.reply = 60s;
  EXPECT_EQ(client.Identify(Request("second"), timing).outcome, RequestOutcome::kRefused);
}

TEST_F(Daemon, CountsWhatItSetsAsideByReason) {
  const auto daemon = StartDaemon();
  const Participant participant(domain_.id());
  Writer<telltale_wire_GnssFix> gnss(participant);
  Writer<telltale_wire_Heading> heading(participant);
  Writer<telltale_wire_Thrusters> thrusters(participant);
  // The daemon hears each of these writers some time after it has matched them here.
  bool heard = false;
  QualitySubscriber qualities(
      participant,
      [&](const Quality& q) {
        heard |= q.gnss_rate_hz > 0.0 && q.heading_rate_hz > 0.0 && q.thrusters_rate_hz > 0.0;
      },
      [](const CodecError&) {});
  std::uint64_t n = 0;
  while (!heard && n < 500) {
    const double time_s = 1e-3 * static_cast<double>(++n);
    gnss.Write(Encode(Telemetry<GnssFix>{kVehicleId, n, {time_s, 37.0 + time_s, -6.0}}));
    heading.Write(Encode(Telemetry<HeadingSample>{kVehicleId, n, {time_s, time_s}}));
    thrusters.Write(Encode(Telemetry<ThrusterSample>{kVehicleId, n, {time_s, 1500.0, 1500.0}}));
    qualities.Wait(50ms);
  }
  ASSERT_TRUE(heard);

  gnss.Write(Encode(Telemetry<GnssFix>{kVehicleId, n + 1, {1.0, 37.0, -6.0}}));
  gnss.Write(Encode(Telemetry<GnssFix>{kVehicleId, n + 2, {2.0, kNan, -6.0}}));
  gnss.Write(Encode(Telemetry<GnssFix>{kVehicleId, n + 3, {3.0, 91.0, -6.0}}));
  gnss.Write(Encode(Telemetry<GnssFix>{kVehicleId, n + 4, {1.0, 37.0, -6.0}}));
  gnss.Write(Encode(Telemetry<GnssFix>{kVehicleId, n + 8, {4.0, 37.5, -6.0}}));
  heading.Write(Encode(Telemetry<HeadingSample>{kVehicleId, n + 1, {kNan, 90.0}}));
  heading.Write(Encode(Telemetry<HeadingSample>{"stranger", 1, {1.0, 90.0}}));
  thrusters.Write(Encode(Telemetry<ThrusterSample>{kVehicleId, n + 1, {1.0, 1500.0, 9000.0}}));
  auto unterminated = Encode(Telemetry<ThrusterSample>{kVehicleId, 0, {1.0, 1500.0, 1500.0}});
  std::memset(unterminated.vehicle_id, 'x', sizeof unterminated.vehicle_id);
  thrusters.Write(unterminated);
  auto spaced = Encode(Telemetry<ThrusterSample>{kVehicleId, 1, {1.0, 1500.0, 1500.0}});
  std::strcpy(spaced.vehicle_id, "two words");
  thrusters.Write(spaced);

  const auto quality = AwaitQuality(kVehicleId, [](const Quality& q) {
    return CountOf(q, "thrusters", "OUT_OF_RANGE") == 1 &&
           CountOf(q, "heading", "NOT_FINITE") == 1 && q.lost == 3;
  });
  ASSERT_TRUE(quality);
  EXPECT_EQ(CountOf(*quality, "gnss", "NOT_FINITE"), 1u);
  EXPECT_EQ(CountOf(*quality, "gnss", "OUT_OF_RANGE"), 1u);
  EXPECT_EQ(CountOf(*quality, "gnss", "DUPLICATE"), 1u);
  const auto unattributed = AwaitQuality(std::string(kUnattributed), [](const Quality& q) {
    return CountOf(q, "thrusters", "MALFORMED_VEHICLE_ID") == 1 &&
           CountOf(q, "thrusters", "UNREADABLE") == 1;
  });
  ASSERT_TRUE(unattributed);
  EXPECT_EQ(CountOf(*unattributed, "heading", "UNKNOWN_VEHICLE"), 1u);
  // What cannot even be read ends in Cyclone DDS, which tells the log.
  EXPECT_TRUE(daemon->WaitForOutput("deserialization telltale/telemetry/thrusters"));
}

TEST_F(Daemon, AnswersACorrelationIdOnce) {
  const auto daemon = StartDaemon();
  ReplaySimulation();
  const Participant participant(domain_.id());
  IdentificationClient client(participant);
  const RequestTiming timing{.match = 60s, .reply = 60s, .retry = 1s};
  const auto first = client.Identify(Request("the-same"), timing);
  const auto again = client.Identify(Request("the-same"), timing);
  const auto other = client.Identify(Request("another"), timing);
  ASSERT_EQ(first.outcome, RequestOutcome::kPublished);
  ASSERT_EQ(again.outcome, RequestOutcome::kPublished);
  ASSERT_EQ(other.outcome, RequestOutcome::kPublished);
  EXPECT_EQ(first.reply->model->revision, 1u);
  EXPECT_EQ(again.reply->model->revision, 1u);
  EXPECT_EQ(other.reply->model->revision, 2u);
}

TEST_F(Daemon, FailsARequestItCannotTakeAndGoesOn) {
  const auto daemon = StartDaemon();
  const Participant participant(domain_.id());
  IdentificationClient client(participant);
  const RequestTiming timing{.match = 60s, .reply = 60s, .retry = 1s};
  IdentifyRequest wrong = Request("too-few-replicates");
  wrong.bootstrap_replicates = 7;
  const auto answer = client.Identify(wrong, timing);
  ASSERT_EQ(answer.outcome, RequestOutcome::kFailed);
  EXPECT_THAT(answer.reply->message, HasSubstr("bootstrap_replicates"));
  EXPECT_EQ(client.Identify(Request("sound"), timing).outcome, RequestOutcome::kRefused);
}

TEST_F(Daemon, AnswersARequestItCannotRead) {
  const auto daemon = StartDaemon();
  const Participant participant(domain_.id());
  Writer<telltale_wire_IdentifyRequest> requests(participant);
  Reader<telltale_wire_IdentifyReply> replies(participant);
  IdentifyRequest wrong = Request("unreadable");
  wrong.dead_zone_source = DeadZoneSource::kGiven;
  auto wire = Encode(wrong);
  wire->dead_zone_forward = 7.0;
  std::string message;
  WaitSet wait_set(participant);
  wait_set.Attach(replies, [&] {
    replies.Take(
        [&](const telltale_wire_IdentifyReply& reply) { message = Decode(reply)->message; });
  });
  WriteUntil(requests, wire, wait_set, [&] { return !message.empty(); });
  EXPECT_THAT(message, HasSubstr("dead_zone"));
}

TEST_F(Daemon, StopsCleanlyWhenTold) {
  // At once, when any of its threads may be the one that is told.
  for (int round = 0; round < 5; ++round) {
    for (const int signal : {SIGTERM, SIGINT}) {
      const auto daemon = StartDaemon();
      daemon->Signal(signal);
      EXPECT_EQ(daemon->Wait(), 0) << daemon->output();
    }
  }
}

// A line of the log is some hundred bytes, and the pipe has room for forty of them.
TEST_F(Daemon, AnswersAndStopsWhereNobodyReadsItsLog) {
  Process daemon({TELLTALED, "--config", config_file_}, Process::Output::kUnread);
  const Participant participant(domain_.id());
  FleetClient client(participant);
  for (int reload = 0; reload < 200; ++reload) {
    FleetRequest list;
    list.correlation_id = NewCorrelationId();
    list.command = FleetCommand::kList;
    ASSERT_EQ(client.Ask(list, {.match = 60s, .reply = 60s, .retry = 1s}).outcome,
              RequestOutcome::kAnswered);
    daemon.Signal(SIGHUP);
  }
  daemon.Signal(SIGTERM);
  EXPECT_EQ(daemon.Wait(60s), 0);
}

TEST_F(Daemon, RefusesAWrongConfigurationNamingTheField) {
  const auto wrong = folder_.Write("wrong.textproto", "domain: 500\n");
  Process daemon({TELLTALED, "--config", wrong});
  EXPECT_EQ(daemon.Wait(), 2);
  EXPECT_THAT(daemon.output(), HasSubstr("domain"));
  EXPECT_THAT(daemon.output(), HasSubstr("500"));

  Process missing({TELLTALED, "--config", folder_.Path() / "nowhere.textproto"});
  EXPECT_EQ(missing.Wait(), 2);
  Process without({TELLTALED});
  EXPECT_EQ(without.Wait(), 2);
  Process help({TELLTALED, "--help"});
  EXPECT_EQ(help.Wait(), 0);
}

TEST_F(Daemon, LeavesAStateDirectoryToTheDaemonThatHasIt) {
  const auto first = StartDaemon();
  Process second({TELLTALED, "--config", config_file_});
  EXPECT_EQ(second.Wait(), 1);
  EXPECT_THAT(second.output(), HasSubstr("in use by another telltaled"));
  first->Signal(SIGKILL);
  first->Wait();
  StartDaemon();
}

TEST_F(Daemon, SaysThatItsDiskIsFullAndGoesOn) {
  // No file grows beyond 64 KiB, and writes that would fail as on a full disk.
  Process daemon(
      {"/bin/sh", "-c",
       "trap '' XFSZ; ulimit -f 128; exec " TELLTALED " --config " + config_file_.string()});
  ASSERT_TRUE(daemon.WaitForOutput("serving 1 vehicles")) << daemon.output();
  ReplaySimulation();
  std::optional<int> exit_code = 0;
  std::string output;
  for (int seed = 1; seed < 10 && exit_code == 0; ++seed) {
    const auto identify =
        Start({"identify", "--vehicle-id", kVehicleId, "--seed", std::to_string(seed)});
    exit_code = identify->Wait();
    output = identify->output();
  }
  EXPECT_EQ(exit_code, 1) << output;
  EXPECT_THAT(output, HasSubstr("disk"));
  EXPECT_TRUE(daemon.WaitForOutput("[error] identification of yellowfish"));
  const auto monitor = Start({"monitor", "--once", "--json"});
  EXPECT_EQ(monitor->Wait(), 0);
  EXPECT_THAT(monitor->output(), HasSubstr("NOT_SAVED"));
}

// More at once than Cyclone DDS lets on one host by default.
TEST_F(Daemon, LetsManyClientsOnOneHost) {
  setenv("CYCLONEDDS_URI", "file://" TELLTALE_SOURCE_DIR "/deploy/cyclonedds/loopback.xml", 1);
  setenv("TELLTALE_DDS_TAG", "LetsManyClientsOnOneHost", 1);
  std::vector<std::unique_ptr<Process>> clients;
  for (int i = 0; i < 35; ++i) clients.push_back(Start({"monitor", "--once", "--timeout", "5"}));
  for (const auto& client : clients) {
    EXPECT_EQ(client->Wait(), 1);
    EXPECT_THAT(client->output(), HasSubstr("no reports of a daemon"));
  }
}

TEST_F(Daemon, SaysThatAnotherPublishesModels) {
  const auto daemon = StartDaemon();
  const Participant participant(domain_.id());
  {
    const Writer<telltale_wire_Model> rival(participant);
    EXPECT_TRUE(daemon->WaitForOutput("1 other participants publish models on this domain"));
  }
  EXPECT_TRUE(daemon->WaitForOutput("this daemon alone publishes models"));
}

TEST_F(Daemon, FailsWhereItCannotKeepModels) {
  folder_.Write("state", "a file where a folder is needed");
  Process daemon({TELLTALED, "--config", config_file_});
  EXPECT_EQ(daemon.Wait(), 1);
  EXPECT_THAT(daemon.output(), HasSubstr("state"));
}

}  // namespace
}  // namespace telltale
