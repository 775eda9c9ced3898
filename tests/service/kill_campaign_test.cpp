#include <signal.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/fmt/fmt.h>

#include "service/service_fixture.hpp"
#include "support/stable_boat.hpp"
#include "telltale/client/bus/reader.hpp"
#include "telltale/client/bus/wait_set.hpp"
#include "telltale/client/bus/writer.hpp"
#include "telltale/client/fleet/fleet_client.hpp"
#include "telltale/client/fleet/subscriber.hpp"
#include "telltale/client/fleet/telemetry_publisher.hpp"
#include "telltale/core/base/random.hpp"
#include "telltale/core/data/recording_parts.hpp"
#include "telltale/service/jobs/request_journal.hpp"
#include "telltale/service/models/model_store.hpp"
#include "telltale/service/storage/stores.hpp"
#include "telltale/service/windows/window_store.hpp"

namespace telltale {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::Not;
using CampaignClock = std::chrono::steady_clock;

constexpr double kSentAtOnceS = 0.5;        // of telemetry at a time
constexpr auto kSentEvery = 50ms;           // so the boat lives at ten times real time
constexpr double kCampaignWindowS = 100.0;  // of the daemon's configuration, as the next
constexpr double kCampaignSavePeriodS = 0.2;
constexpr int kMostSteps = 60;                  // from a start to the kill
constexpr int kCoverageReplicates = 200;        // replicates: seconds of work
constexpr std::chrono::seconds kPatience{300};  // coverage checks leave the processors to all else

/// TELLTALE_KILLS says how often.
int Kills() {
  const char* wanted = std::getenv("TELLTALE_KILLS");  // NOLINT(concurrency-mt-unsafe)
  return wanted == nullptr ? 10 : std::max(1, std::atoi(wanted));
}

double SecondsSince(CampaignClock::time_point since) {
  return std::chrono::duration<double>(CampaignClock::now() - since).count();
}

/// A boat that speaks, and a client that notes what it is told.
class BoatAndClient {
 public:
  BoatAndClient(std::uint32_t domain, Recording recording)
      : participant_(domain),
        wait_set_(participant_),
        qualities_(
            participant_, wait_set_,
            [this](const Quality& quality) {
              if (quality.vehicle_id == "yellowfish") newest_quality_ = quality;
            },
            [](const CodecError& error) { ADD_FAILURE() << error.Message(); }),
        models_(
            participant_, wait_set_, [this](const PublishedModel& model) { Note(model); },
            [](const CodecError& error) { ADD_FAILURE() << error.Message(); }),
        publisher_(participant_, "yellowfish"),
        recording_(std::move(recording)) {
    wait_set_.Attach(progress_, [this] {
      progress_.Take([this](const auto& wire) { acknowledged_.insert(wire.correlation_id); });
    });
    wait_set_.Attach(replies_, [this] {
      replies_.Take([this](const auto& wire) {
        if (auto reply = Decode(wire)) replies_seen_.insert_or_assign(wire.correlation_id, *reply);
      });
    });
  }

  /// False where the daemon that was just started is not connected within a minute. Ends that a
  /// killed daemon left count as connected for some time: only a report shows that this one is.
  bool AwaitDaemon() {
    newest_quality_.reset();
    return Await([this] { return newest_quality_.has_value(); }) &&
           WaitForMatch(participant_, {requests_, progress_, replies_}, 60s) &&
           publisher_.WaitForReaders(60s);
  }

  template <class Condition>
  bool Await(Condition condition) {
    const auto deadline = CampaignClock::now() + 60s;
    while (!condition() && CampaignClock::now() < deadline) wait_set_.Wait(100ms);
    return condition();
  }

  /// Sends the next telemetry, and handles what comes until the step is over.
  void Step() {
    const auto end = CampaignClock::now() + kSentEvery;
    const Recording part = Between(recording_, sent_to_s_, sent_to_s_ + kSentAtOnceS);
    for (const GnssFix& fix : part.gnss) publisher_.Publish(fix);
    for (const HeadingSample& sample : part.heading) publisher_.Publish(sample);
    for (const ThrusterSample& sample : part.thrusters) publisher_.Publish(sample);
    sent_to_s_ += kSentAtOnceS;
    sent_at_.emplace(sent_to_s_, CampaignClock::now());
    Handle(end - CampaignClock::now());
  }

  void Handle(std::chrono::nanoseconds duration) {
    const auto end = CampaignClock::now() + duration;
    do {
      wait_set_.Wait(end - CampaignClock::now());
    } while (CampaignClock::now() < end);
  }

  void Send(const IdentifyRequest& request) { requests_.Write(Encode(request)); }

  /// The reply, asked for until it comes; nothing where that takes longer.
  std::optional<IdentifyReply> Ask(const IdentifyRequest& request,
                                   std::chrono::seconds patience = 60s) {
    const auto deadline = CampaignClock::now() + patience;
    while (!ReplyTo(request.correlation_id) && CampaignClock::now() < deadline) {
      Send(request);
      const auto again = CampaignClock::now() + 1s;
      while (!ReplyTo(request.correlation_id) && CampaignClock::now() < again) {
        wait_set_.Wait(again - CampaignClock::now());
      }
    }
    return ReplyTo(request.correlation_id);
  }

  std::optional<IdentifyReply> ReplyTo(const std::string& correlation_id) const {
    const auto found = replies_seen_.find(correlation_id);
    return found == replies_seen_.end() ? std::nullopt : std::optional(found->second);
  }
  bool Acknowledged(const std::string& correlation_id) const {
    return acknowledged_.contains(correlation_id);
  }

  /// Those of the requests that were acknowledged and have no reply.
  std::set<std::string> Unanswered(const std::set<std::string>& asked) const {
    std::set<std::string> unanswered;
    for (const std::string& id : asked) {
      if (Acknowledged(id) && !ReplyTo(id)) unanswered.insert(id);
    }
    return unanswered;
  }

  /// When each revision was published, by what the topic has said so far.
  const std::map<std::uint64_t, double>& published() const { return published_; }

  /// The time of the fix that the newest report names. Empty where there is none such.
  std::optional<double> ReportedFixS() const {
    if (!newest_quality_ || !newest_quality_->position) return std::nullopt;
    const QualityPosition& position = *newest_quality_->position;
    const auto fix = std::ranges::find_if(recording_.gnss, [&](const GnssFix& one) {
      return one.latitude_deg == position.latitude_deg &&
             one.longitude_deg == position.longitude_deg;
    });
    return fix == recording_.gnss.end() ? std::nullopt : std::optional(fix->time_s);
  }

  /// The span of the window that the newest report names.
  double ReportedWindowS() const { return newest_quality_ ? newest_quality_->window_s : 0.0; }

  /// How long before `until` the first fix after `time_s` was sent; 0 where there is none.
  double SentBefore(double time_s, CampaignClock::time_point until) const {
    const auto next = std::ranges::upper_bound(recording_.gnss, time_s, {}, &GnssFix::time_s);
    if (next == recording_.gnss.end() || next->time_s > sent_to_s_) return 0.0;
    const auto sent = sent_at_.lower_bound(next->time_s);
    return std::chrono::duration<double>(until - sent->second).count();
  }
  double sent_to_s() const { return sent_to_s_; }

 private:
  void Note(const PublishedModel& model) {
    const auto [known, is_new] = published_.emplace(model.revision, model.published_unix_s);
    // The same revision again is the same model.
    EXPECT_EQ(known->second, model.published_unix_s) << "revision " << model.revision;
  }

  Participant participant_;
  WaitSet wait_set_;
  Writer<telltale_wire_IdentifyRequest> requests_{participant_};
  Reader<telltale_wire_IdentifyProgress> progress_{participant_};
  Reader<telltale_wire_IdentifyReply> replies_{participant_};
  TopicSubscription<telltale_wire_Quality, Quality> qualities_;
  ModelSubscription models_;
  TelemetryPublisher publisher_;
  Recording recording_;
  double sent_to_s_ = -1e-9;
  std::map<double, CampaignClock::time_point> sent_at_;  ///< by the end of the step
  std::optional<Quality> newest_quality_;
  std::set<std::string> acknowledged_;
  std::map<std::string, IdentifyReply> replies_seen_;
  std::map<std::uint64_t, double> published_;
};

using Published = std::map<std::uint64_t, double>;

/// What the kills have cost.
struct Tally {
  std::size_t published = 0;
  int models_lost = 0;
  int acknowledged = 0;
  int unanswered = 0;
  int answer_under_way = 0;  ///< the log of the killed daemon has it, and the client does not
  int requests_lost = 0;
  int chunks_lost = 0;  ///< restarts without telemetry that had been on disk
  std::vector<double> missing_s;
  std::vector<double> recovery_s;

  static std::string Spread(std::vector<double> values) {
    std::ranges::sort(values);
    return fmt::format("median {:.2f}, worst {:.2f}", values[values.size() / 2], values.back());
  }

  void Print() const {
    std::cout << fmt::format(
        "{} kills\nmodels published {}, lost {}\nrequests acknowledged {}, without an answer at "
        "the kill {} (of them {} under way to the client), lost {}\nwindow missing, s before the "
        "kill: {} (saved every {} s); saved and "
        "lost {} times\nfirst identification after the kill, s: {}\n",
        recovery_s.size(), published, models_lost, acknowledged, unanswered, answer_under_way,
        requests_lost, Spread(missing_s), kCampaignSavePeriodS, chunks_lost, Spread(recovery_s));
  }
};

/// Random moments of a daemon under load.
class CampaignTest : public ServiceTest {
 protected:
  explicit CampaignTest(Engine engine) : ServiceTest(engine) {
    config_file_ = folder_.Write(
        "campaign.textproto",
        fmt::format("domain: {}\nvehicle_files: \"vehicle.textproto\"\n{}"
                    "identification {{ bootstrap_replicates: 0 }}\nquality_period_s: 0.1\n"
                    "window {{ duration_s: {} save_period_s: {} }}\n",
                    domain_.id(), StorageLines(), kCampaignWindowS, kCampaignSavePeriodS));
  }

  static Recording LongRecording() {
    return SimulatedRecording(testing::StableBoat(), 0.0,
                              kCampaignWindowS + Kills() * kMostSteps * kSentAtOnceS, 4);
  }

  IdentifyRequest Plain(const std::string& correlation_id) {
    IdentifyRequest request = Request(correlation_id);
    request.estimator = Estimator::kOneStep;
    request.seed = ++seed_;  // unlike any other, so that it joins none
    return request;
  }

  int Draw(int most) { return 1 + static_cast<int>(random_() % static_cast<unsigned>(most)); }

  /// Lives to a random moment. Asks for an identification, and for one with a coverage check, which
  /// takes seconds, at random moments, of which one may not come. Returns what it has asked.
  std::vector<IdentifyRequest> Live(BoatAndClient& client, int round) {
    const std::string number = std::to_string(round);
    IdentifyRequest checked = Plain("checked-" + number);
    checked.coverage_check_replicates = kCoverageReplicates;
    const int steps = Draw(kMostSteps);
    const int plain_at = Draw(steps);
    const int checked_at = Draw(steps);
    std::vector<IdentifyRequest> asked;
    for (int step = 1; step <= steps; ++step) {
      const std::size_t before = asked.size();
      if (step == plain_at) asked.push_back(Plain("plain-" + number));
      if (step == checked_at) asked.push_back(checked);
      for (std::size_t i = before; i < asked.size(); ++i) client.Send(asked[i]);
      client.Step();
    }
    return asked;
  }

  /// The models that the daemon keeps.
  Published History() const {
    const Participant participant(domain_.id());
    FleetRequest request;
    request.correlation_id = NewCorrelationId();
    request.command = FleetCommand::kHistory;
    request.vehicle_ids = {kVehicleId};
    const FleetResult result =
        FleetClient(participant).Ask(request, {.match = 60s, .reply = 60s, .retry = 1s});
    Published history;
    if (!result.reply) return history;
    for (const ModelSummary& model : result.reply->models) {
      history.emplace(model.revision, model.published_unix_s);
    }
    return history;
  }

  /// How many of the models are not there, or are others, but for those that 200 later ones have
  /// displaced.
  static int Missing(const Published& models, const Published& history) {
    constexpr std::uint64_t kKept = 190;
    return static_cast<int>(std::ranges::count_if(models, [&](const auto& model) {
      const bool displaced = models.rbegin()->first - model.first >= kKept;
      const auto found = history.find(model.first);
      return !displaced && (found == history.end() || found->second != model.second);
    }));
  }

  /// Sees the window that the new daemon has, and its first answer.
  void Recover(BoatAndClient& client, int round, double saved_to_s,
               CampaignClock::time_point killed, Tally& tally) {
    constexpr double kFixPeriodS = 0.2;
    ASSERT_TRUE(client.AwaitDaemon());
    const auto restored_to_s = client.ReportedFixS();
    const double window_s = client.ReportedWindowS();
    const auto check = client.Ask(Plain("check-" + std::to_string(round)));
    tally.recovery_s.push_back(SecondsSince(killed));
    ASSERT_TRUE(restored_to_s);
    if (*restored_to_s < saved_to_s - kFixPeriodS) ++tally.chunks_lost;
    tally.missing_s.push_back(client.SentBefore(*restored_to_s, killed));
    ASSERT_TRUE(check);
    ASSERT_TRUE(check->model) << check->message
                              << (check->refusals.empty() ? "" : check->refusals[0].reason);
    EXPECT_GT(window_s, 0.95 * kCampaignWindowS);
  }

  /// Sees that what was acknowledged is finished without being asked for again, and that who asks
  /// gets the reply. `before` is the log of the daemon that was killed.
  static void Collect(BoatAndClient& client, const std::string& before, Process& daemon,
                      const std::vector<IdentifyRequest>& asked, Tally& tally) {
    for (const IdentifyRequest& request : asked) {
      const std::string& id = request.correlation_id;
      if (!client.Acknowledged(id)) continue;
      ++tally.acknowledged;
      if (client.ReplyTo(id)) continue;
      ++tally.unanswered;
      const std::string outcome = " for " + id + ": ";
      const bool was_answered = before.find(outcome) != std::string::npos;
      tally.answer_under_way += was_answered ? 1 : 0;
      const bool finished = was_answered || daemon.WaitForOutput(outcome, kPatience);
      const auto reply = client.Ask(request, kPatience);
      if (finished && reply && reply->model) continue;
      ++tally.requests_lost;
      ADD_FAILURE() << id << (finished ? " is finished" : " is not finished")
                    << (reply ? ", the reply: " + reply->message : ", no reply") << '\n'
                    << daemon.output();
    }
  }

  RandomEngine random_{20};
  std::uint64_t seed_ = 0;
};

class KillCampaign : public CampaignTest, public ::testing::WithParamInterface<Engine> {
 protected:
  KillCampaign() : CampaignTest(GetParam()) {}
};

INSTANTIATE_TEST_SUITE_P(Engines, KillCampaign, kEngines, EngineName);

TEST_P(KillCampaign, LosesNothingThatWasAcknowledged) {
  BoatAndClient client(domain_.id(), LongRecording());
  auto daemon = StartDaemon();
  ASSERT_TRUE(client.AwaitDaemon());
  while (client.sent_to_s() < kCampaignWindowS) client.Step();
  const auto windows = Storage().Open(WindowsSchema());
  Tally tally;
  for (int kill = 0; kill < Kills(); ++kill) {
    SCOPED_TRACE("kill " + std::to_string(kill));
    const auto asked = Live(client, kill);
    const double saved_to_s = SavedToS(*windows, kVehicleId);
    client.Handle(std::chrono::milliseconds(Draw(50)));
    daemon->Signal(SIGKILL);
    const auto killed = CampaignClock::now();
    daemon->Wait();
    client.Handle(10ms);  // what was under way
    const Published published = client.published();
    const std::string before = daemon->output();
    daemon = StartDaemon();
    Recover(client, kill, saved_to_s, killed, tally);
    if (HasFatalFailure()) break;
    tally.models_lost += Missing(published, History());
    Collect(client, before, *daemon, asked, tally);
    EXPECT_THAT(daemon->output(), Not(HasSubstr("damaged")));
  }
  tally.published = client.published().size();
  tally.Print();
  EXPECT_EQ(tally.models_lost, 0);
  EXPECT_EQ(tally.requests_lost, 0);
  EXPECT_EQ(tally.chunks_lost, 0);
}

/// What a store holds that is opened after the power was cut.
struct StoreContents {
  Published models;
  std::set<std::string> requests;
  std::size_t unreadable_chunks = 0;

  explicit StoreContents(const telltale::Storage& storage) {
    for (const StoredModel& stored : ModelStore(storage).History("yellowfish")) {
      models.emplace(stored.model.revision, stored.model.published_unix_s);
    }
    for (const AnyRequest& request : RequestJournal(storage).TakeUnanswered()) {
      requests.insert(std::visit([](const auto& kind) { return kind.correlation_id; }, request));
    }
    unreadable_chunks = WindowStore(storage).Load("yellowfish", [](const Recording&) {});
  }
};

/// Copies of a store as a loss of power would leave it.
class PowerCutCampaign : public CampaignTest {
 protected:
  PowerCutCampaign() : CampaignTest(Engine::kSqlite) {}

  std::filesystem::path State() const { return folder_.Path() / "state"; }

  /// The files as they are between two writes. SQLite does without the third file, which is memory
  /// that processes share.
  static void CopyStore(const std::filesystem::path& from, const std::filesystem::path& to) {
    std::filesystem::create_directories(to);
    for (const auto& entry : std::filesystem::directory_iterator(from)) {
      const std::string name = entry.path().filename();
      if (!name.ends_with(".sqlite") && !name.ends_with("-wal")) continue;
      std::filesystem::copy_file(entry.path(), to / name);
    }
  }

  /// Cuts the newest of what was written off, at any byte: as if it had not reached the disk.
  void TearLogs(const std::filesystem::path& folder) {
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      const auto size = static_cast<int>(std::filesystem::file_size(entry.path()));
      if (!entry.path().string().ends_with("-wal") || size == 0) continue;
      std::filesystem::resize_file(entry.path(), static_cast<unsigned>(Draw(size)) - 1);
    }
  }

  static bool WasDamaged(const std::filesystem::path& folder) {
    return std::ranges::any_of(std::filesystem::directory_iterator(folder), [](const auto& entry) {
      return entry.path().string().find("damaged") != std::string::npos;
    });
  }

  /// Whether the revisions follow each other from the first on that is kept.
  static bool HasNoHole(const Published& models) {
    return models.empty() || models.rbegin()->first - models.begin()->first + 1 == models.size();
  }
};

TEST_F(PowerCutCampaign, LeavesAWholeStoreAtAnyWrite) {
  BoatAndClient client(domain_.id(), LongRecording());
  const auto daemon = StartDaemon();
  ASSERT_TRUE(client.AwaitDaemon());
  while (client.sent_to_s() < kCampaignWindowS) client.Step();
  std::set<std::string> asked;
  for (int cut = 0; cut < Kills(); ++cut) {
    SCOPED_TRACE("cut " + std::to_string(cut));
    for (const IdentifyRequest& request : Live(client, cut)) asked.insert(request.correlation_id);
    client.Send(Plain("under-way-" + std::to_string(cut)));
    client.Handle(std::chrono::milliseconds(Draw(200)));
    const auto folder = folder_.Path() / ("cut-" + std::to_string(cut));
    const auto torn = folder_.Path() / ("torn-" + std::to_string(cut));
    daemon->Suspend();
    CopyStore(State(), folder);
    CopyStore(State(), torn);
    client.Handle(50ms);  // what it had sent
    const Published published = client.published();
    const std::set<std::string> unanswered = client.Unanswered(asked);
    daemon->Resume();
    const StoreContents contents{telltale::Storage(folder)};
    EXPECT_EQ(Missing(published, contents.models), 0);
    EXPECT_TRUE(std::ranges::includes(contents.requests, unanswered));
    EXPECT_EQ(contents.unreadable_chunks, 0u);
    EXPECT_FALSE(WasDamaged(folder));
    TearLogs(torn);
    const StoreContents rest{telltale::Storage(torn)};
    EXPECT_TRUE(HasNoHole(rest.models));
    EXPECT_TRUE(std::ranges::includes(contents.models, rest.models));
    EXPECT_EQ(rest.unreadable_chunks, 0u);
    EXPECT_FALSE(WasDamaged(torn));
  }
  std::cout << Kills() << " cuts of the power, " << client.published().size()
            << " models published\n";
}

}  // namespace
}  // namespace telltale
