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
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/fmt/fmt.h>

#include "service/kill_campaign.hpp"
#include "telltale/client/fleet/fleet_client.hpp"
#include "telltale/core/base/random.hpp"
#include "telltale/service/jobs/request_journal.hpp"
#include "telltale/service/models/model_store.hpp"
#include "telltale/service/storage/stores.hpp"
#include "telltale/service/windows/window_store.hpp"

namespace telltale {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::Not;

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
  KillTally tally;
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
    for (const auto& [request, attempts] : RequestJournal(storage).TakeUnanswered()) {
      requests.insert(CorrelationIdOf(request));
    }
    unreadable_chunks = WindowStore(storage).Load("yellowfish", [](const Recording&) {});
  }
};

/// Copies of a daemon's store between two writes. What a disk loses of writes that were not flushed
/// is storage/power_cut_test.cpp's.
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

  static bool WasDamaged(const std::filesystem::path& folder) {
    return std::ranges::any_of(std::filesystem::directory_iterator(folder), [](const auto& entry) {
      return entry.path().string().find("damaged") != std::string::npos;
    });
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
    daemon->Suspend();
    CopyStore(State(), folder);
    client.Handle(50ms);  // what it had sent
    const Published published = client.published();
    const std::set<std::string> unanswered = client.Unanswered(asked);
    daemon->Resume();
    const StoreContents contents{telltale::Storage(folder)};
    EXPECT_EQ(Missing(published, contents.models), 0);
    EXPECT_TRUE(std::ranges::includes(contents.requests, unanswered));
    EXPECT_EQ(contents.unreadable_chunks, 0u);
    EXPECT_FALSE(WasDamaged(folder));
  }
  std::cout << Kills() << " cuts of the power, " << client.published().size()
            << " models published\n";
}

}  // namespace
}  // namespace telltale
