#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <spdlog/fmt/fmt.h>

#include "service/boat_and_client.hpp"
#include "service/service_fixture.hpp"
#include "support/stable_boat.hpp"
#include "telltale/client/fleet/fleet_client.hpp"
#include "telltale/core/base/random.hpp"

namespace telltale {

inline constexpr double kCampaignWindowS = 100.0;  // of the daemon's configuration, as the next
inline constexpr double kCampaignSavePeriodS = 0.2;
inline constexpr int kMostSteps = 60;            // from a start to the kill
inline constexpr int kCoverageReplicates = 200;  // replicates: seconds of work
inline constexpr std::chrono::seconds kPatience{
    300};  // coverage checks leave the processors to all else

/// TELLTALE_KILLS says how often.
inline int Kills() {
  const char* wanted = std::getenv("TELLTALE_KILLS");  // NOLINT(concurrency-mt-unsafe)
  return wanted == nullptr ? 10 : std::max(1, std::atoi(wanted));
}

using Published = std::map<std::uint64_t, double>;

/// What the kills have cost.
struct KillTally {
  std::size_t published = 0;
  int models_lost = 0;
  int acknowledged = 0;
  int unanswered = 0;
  int answer_under_way = 0;  ///< the log of the killed daemon has it, and the client does not
  int requests_lost = 0;
  int chunks_lost = 0;  ///< restarts without telemetry that had been on disk
  std::vector<double> missing_s;
  std::vector<double> serving_s;    ///< from the kill until the next daemon says that it serves
  std::vector<double> connected_s;  ///< until it is connected to the client
  std::vector<double> recovery_s;   ///< until it has answered the first identification

  static std::string Spread(std::vector<double> values) {
    std::ranges::sort(values);
    return fmt::format("median {:.2f}, worst {:.2f}", values[values.size() / 2], values.back());
  }

  void Print() const {
    std::cout << fmt::format(
        "{} kills\nmodels published {}, lost {}\nrequests acknowledged {}, without an answer at "
        "the kill {} (of them {} under way to the client), lost {}\nwindow missing, s before the "
        "kill: {} (saved every {} s); saved and "
        "lost {} times\nafter the kill, s: the next daemon serves {}; is connected {}; has "
        "answered the first identification {}\n",
        recovery_s.size(), published, models_lost, acknowledged, unanswered, answer_under_way,
        requests_lost, Spread(missing_s), kCampaignSavePeriodS, chunks_lost, Spread(serving_s),
        Spread(connected_s), Spread(recovery_s));
  }
};

/// Random moments of a daemon under load.
class CampaignTest : public ServiceTest {
 protected:
  explicit CampaignTest(Engine engine) : ServiceTest(engine) {
    config_file_ = folder_.Write(
        "campaign.textproto",
        fmt::format("domain: {}\nvehicle_files: \"vehicle.textproto\"\n{}"
                    "identification {{ bootstrap_replicates: 0 structure: \"static\" "
                    "}}\nquality_period_s: 0.1\n"
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
    const FleetResult result = FleetClient(participant)
                                   .Ask(request, {.match = std::chrono::seconds(60),
                                                  .reply = std::chrono::seconds(60),
                                                  .retry = std::chrono::seconds(1)});
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
               CampaignClock::time_point killed, KillTally& tally) {
    constexpr double kFixPeriodS = 0.2;
    tally.serving_s.push_back(SecondsSince(killed));
    ASSERT_TRUE(client.AwaitDaemon());
    tally.connected_s.push_back(SecondsSince(killed));
    const auto restored_to_s = client.ReportedFixS();
    const double window_s = client.ReportedWindowS();
    const auto check = client.Ask(Plain("check-" + std::to_string(round)));
    tally.recovery_s.push_back(SecondsSince(killed));
    ASSERT_TRUE(restored_to_s);
    if (*restored_to_s < saved_to_s - kFixPeriodS) ++tally.chunks_lost;
    tally.missing_s.push_back(client.SentBefore(*restored_to_s, killed));
    client.ForgetWhatWasSent();
    ASSERT_TRUE(check);
    ASSERT_TRUE(check->model) << check->message
                              << (check->refusals.empty() ? "" : check->refusals[0].reason);
    EXPECT_GT(window_s, 0.95 * kCampaignWindowS);
  }

  /// Sees that what was acknowledged is finished without being asked for again, and that who asks
  /// gets the reply. `before` is the log of the daemon that was killed.
  static void Collect(BoatAndClient& client, const std::string& before, Process& daemon,
                      const std::vector<IdentifyRequest>& asked, KillTally& tally) {
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

}  // namespace telltale
