#include <signal.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <spdlog/fmt/fmt.h>

#include "service/kill_campaign.hpp"
#include "service/standby/daemon_pair.hpp"

namespace telltale {
namespace {

using namespace std::chrono_literals;

constexpr double kLeaseS = 2.0;
constexpr double kSpokenS = 100.0;  // of telemetry from one kill to the next, at most

/// What it has cost that the daemon that served was killed.
struct FailOverTally {
  std::vector<double> reports_s;  ///< from the kill to the first report of the other daemon
  std::vector<double> answer_s;   ///< from the kill to the first identification
  int models_lost = 0;
  int acknowledged = 0;
  int unanswered = 0;  ///< at the kill
  int requests_lost = 0;
  int late = 0;  ///< a daemon stepped down, since its loop came late, and took over again

  void Print(const BoatAndClient& client) const {
    std::cout << fmt::format(
        "{} kills, lease {} s\nfirst report of the other daemon after the kill, s: {}\nfirst "
        "identification after the kill, s: {}\nmodels published {}, lost {}\nrequests acknowledged "
        "{}, without an answer at the kill {}, lost {}\nrequests answered with two models "
        "{}\ndaemons that came late and started again "
        "{}\n",
        reports_s.size(), kLeaseS, KillTally::Spread(reports_s), KillTally::Spread(answer_s),
        client.published().size(), models_lost, acknowledged, unanswered, requests_lost,
        client.answered_differently().size(), late);
  }
};

/// Two daemons, of which the one that serves is killed at random moments under load, and returns.
class FailOverCampaign : public CampaignTest {
 protected:
  FailOverCampaign() : CampaignTest(Engine::kSqlite) {}

  void StartPair() {
    serving_ = pair_.Start("one", 2);
    ASSERT_TRUE(DaemonPair::TakesOver(*serving_, 1)) << Logs();
    standby_ = pair_.Start("two", 1);
    ASSERT_TRUE(DaemonPair::StandsBy(*standby_)) << Logs();
  }

  static int TimesLate(const Process& daemon) {
    const std::string log = daemon.output();
    int times = 0;
    for (auto at = log.find("came late"); at != std::string::npos;
         at = log.find("came late", at + 1)) {
      ++times;
    }
    return times;
  }

  std::string Logs() const {
    return "the daemon that serves:\n" + (serving_ ? serving_->output() : "") + "the standby:\n" +
           (standby_ ? standby_->output() : "");
  }

  /// Kills the daemon that serves, and sees the other report and answer.
  void Kill(BoatAndClient& client, int round, FailOverTally& tally) {
    tally.late += TimesLate(*serving_);
    serving_->Signal(SIGKILL);
    const auto killed = CampaignClock::now();
    serving_->Wait();
    client.Handle(10ms);  // what was under way
    const auto reported = client.SpeakUntilReport();
    ASSERT_TRUE(reported) << Logs();
    tally.reports_s.push_back(std::chrono::duration<double>(*reported - killed).count());
    const auto check = client.Ask(Plain("check-" + std::to_string(round)));
    tally.answer_s.push_back(SecondsSince(killed));
    ASSERT_TRUE(check && check->model) << Logs();
    const int term = DaemonPair::NewestTerm(*standby_);
    ASSERT_GT(term, std::exchange(term_, term)) << Logs();
  }

  /// The daemon that was killed comes back as the standby, and learns what was published.
  void Return(BoatAndClient& client) {
    std::swap(serving_, standby_);
    std::swap(serving_name_, standby_name_);
    const std::uint64_t newest = client.published().rbegin()->first;
    standby_ = pair_.Start(standby_name_.first, standby_name_.second);
    ASSERT_TRUE(DaemonPair::StandsBy(*standby_)) << Logs();
    ASSERT_TRUE(DaemonPair::Keeps(*standby_, newest)) << Logs();
    ASSERT_TRUE(DaemonPair::IsComplete(*standby_)) << Logs();
  }

  /// Sees that what was acknowledged is answered.
  static void CollectReplies(BoatAndClient& client, const std::vector<IdentifyRequest>& asked,
                             const std::set<std::string>& unanswered, FailOverTally& tally) {
    for (const IdentifyRequest& request : asked) {
      if (!client.Acknowledged(request.correlation_id)) continue;
      ++tally.acknowledged;
      if (!unanswered.contains(request.correlation_id)) continue;
      ++tally.unanswered;
      const auto reply = client.Ask(request, kPatience);
      if (reply && reply->model) continue;
      ++tally.requests_lost;
      ADD_FAILURE() << request.correlation_id << (reply ? ": " + reply->message : ": no reply");
    }
  }

  static std::set<std::string> IdsOf(const std::vector<IdentifyRequest>& requests) {
    std::set<std::string> ids;
    for (const IdentifyRequest& request : requests) ids.insert(request.correlation_id);
    return ids;
  }

  DaemonPair pair_{
      domain_.id(), folder_, kLeaseS,
      fmt::format("identification {{ bootstrap_replicates: 0 structure: \"static\" }}\n"
                  "window {{ duration_s: {} save_period_s: {} }}\n",
                  kCampaignWindowS, kCampaignSavePeriodS)};
  std::unique_ptr<Process> serving_;
  std::unique_ptr<Process> standby_;
  std::pair<std::string, int> serving_name_{"one", 2};
  std::pair<std::string, int> standby_name_{"two", 1};
  int term_ = 1;
};

TEST_F(FailOverCampaign, TakesOverWithinTheLeaseAndLosesNothing) {
  if (std::getenv("TELLTALE_KILLS") == nullptr) {  // NOLINT(concurrency-mt-unsafe)
    GTEST_SKIP()
        << "runs with TELLTALE_KILLS alone, docs/validation/reliability.md has what it shows";
  }
  BoatAndClient client(domain_.id(), SimulatedRecording(testing::StableBoat(), 0.0,
                                                        kCampaignWindowS + Kills() * kSpokenS, 4));
  StartPair();
  ASSERT_TRUE(client.AwaitDaemon());
  while (client.sent_to_s() < kCampaignWindowS) client.Step();
  FailOverTally tally;
  for (int kill = 0; kill < Kills(); ++kill) {
    SCOPED_TRACE("kill " + std::to_string(kill));
    const auto asked = Live(client, kill);
    const auto unanswered = client.Unanswered(IdsOf(asked));
    Kill(client, kill, tally);
    if (HasFatalFailure()) break;
    const Published published = client.published();
    CollectReplies(client, asked, unanswered, tally);
    tally.models_lost += Missing(published, History());
    Return(client);
    if (HasFatalFailure()) break;
  }
  if (HasFatalFailure()) return;
  tally.Print(client);
  EXPECT_EQ(tally.models_lost, 0);
  EXPECT_EQ(tally.requests_lost, 0);
  EXPECT_TRUE(client.answered_differently().empty());
}

}  // namespace
}  // namespace telltale
