#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <spdlog/fmt/fmt.h>

#include "service/jobs/request_called.hpp"
#include "service/storage/recorded_disk.hpp"
#include "support/made_up_identifications.hpp"
#include "support/temporary_folder.hpp"
#include "telltale/core/base/random.hpp"
#include "telltale/service/jobs/request_journal.hpp"
#include "telltale/service/models/model_store.hpp"
#include "telltale/service/windows/window_store.hpp"

namespace telltale {
namespace {

constexpr int kRounds = 150;  // models, each a page or more: the log is copied to the tables often
constexpr double kChunkS = 5.0;

/// TELLTALE_CUTS says how many.
int Cuts() {
  const char* wanted = std::getenv("TELLTALE_CUTS");  // NOLINT(concurrency-mt-unsafe)
  return wanted == nullptr ? 40 : std::max(1, std::atoi(wanted));
}

Recording Chunk(double from_s) {
  Recording chunk;
  for (double time_s = from_s; time_s < from_s + kChunkS; time_s += 0.2) {
    chunk.gnss.push_back({time_s, 37.0, -6.0});
    chunk.heading.push_back({time_s, 10.0});
  }
  return chunk;
}

/// What a store has acknowledged, by the moment of the recorded disk.
struct Acknowledged {
  std::map<std::size_t, std::uint64_t> models;
  std::map<std::size_t, double> saved_to_s;  ///< of the window
  std::map<std::size_t, std::string> requests;
  std::map<std::string, std::size_t> answered;  ///< when a request began to be dropped
  std::size_t opened = 0;                       ///< since then the tables are there

  std::set<std::uint64_t> ModelsBefore(std::size_t moment) const {
    std::set<std::uint64_t> revisions;
    for (const auto& [at, revision] : models) {
      if (at <= moment) revisions.insert(revision);
    }
    return revisions;
  }

  double SavedToBefore(std::size_t moment) const {
    const auto next = saved_to_s.upper_bound(moment);
    return next == saved_to_s.begin() ? 0.0 : std::prev(next)->second;
  }

  /// Those without an answer.
  std::set<std::string> RequestsBefore(std::size_t moment) const {
    std::set<std::string> ids;
    for (const auto& [at, id] : requests) {
      const auto dropped = answered.find(id);
      const bool is_owed = dropped == answered.end() || dropped->second > moment;
      if (at <= moment && is_owed) ids.insert(id);
    }
    return ids;
  }
};

/// What can be read of a store.
struct Contents {
  std::set<std::uint64_t> models;
  std::set<std::string> requests;
  std::size_t unreadable_chunks = 0;
  double saved_to_s = 0.0;  ///< of the window

  explicit Contents(const Storage& storage) {
    for (const StoredModel& stored : ModelStore(storage).History(MadeUpIdentification().vehicle_id))
      models.insert(stored.model.revision);
    for (const auto& [request, attempts] : RequestJournal(storage).TakeUnanswered())
      requests.insert(CorrelationIdOf(request));
    unreadable_chunks = WindowStore(storage).Load("boat", [this](const Recording& chunk) {
      saved_to_s = std::max(saved_to_s, chunk.gnss.back().time_s);
    });
  }
};

/// A store as a daemon uses it, on a disk that is recorded.
class PowerCut : public ::testing::Test {
 protected:
  /// Models, windows and requests, of which every second is answered.
  Acknowledged UseStore(const RecordedDisk& disk) const {
    Acknowledged acknowledged;
    std::mutex mutex;
    const Storage storage(state_);
    ModelStore models(storage);
    WindowStore windows(storage);
    RequestJournal journal(storage);
    acknowledged.opened = disk.Now();
    for (int round = 0; round < kRounds; ++round) {
      const std::string id = "request-" + std::to_string(round);
      journal.Keep(RequestCalled(id), [&, id] {
        const std::lock_guard lock(mutex);
        acknowledged.requests.emplace(disk.Now(), id);
      });
      const Recording chunk = Chunk(kChunkS * round);
      windows.Save({{"boat", chunk}}, {300.0, 1000});
      acknowledged.saved_to_s.emplace(disk.Now(), chunk.gnss.back().time_s);
      const auto revision = models.Save(MadeUpIdentification(), 1.0 + round, {}).model.revision;
      const std::lock_guard lock(mutex);
      acknowledged.models.emplace(disk.Now(), revision);
      if (round % 2 == 0) {
        acknowledged.answered.emplace(id, disk.Now());
        journal.Drop(id);
      }
    }
    return acknowledged;
  }

  bool WasDamaged(const std::filesystem::path& folder) const {
    return std::ranges::any_of(std::filesystem::directory_iterator(folder), [](const auto& entry) {
      return entry.path().string().find("damaged") != std::string::npos;
    });
  }

  TemporaryFolder folder_;
  std::filesystem::path state_ = folder_.Path() / "state";
};

// Each cut is at a write of its own, and takes with it what it likes of what was not yet on the
// disk.
TEST_F(PowerCut, TakesNothingThatWasAcknowledged) {
  Acknowledged acknowledged;
  auto disk = std::make_unique<RecordedDisk>();
  acknowledged = UseStore(*disk);
  const std::size_t end = disk->Now();
  RandomEngine random(27);
  std::size_t models = 0;
  std::size_t requests = 0;
  double window_lost_s = 0.0;
  for (int cut = 0; cut < Cuts(); ++cut) {
    const std::size_t moment =
        acknowledged.opened +
        DrawBelow(random, static_cast<std::uint32_t>(end - acknowledged.opened));
    SCOPED_TRACE(fmt::format("cut {} after {} of {} operations", cut, moment, end));
    const auto left = folder_.Path() / "left";
    disk->LeaveAfterCut(moment, state_, left, random);
    const Contents contents{Storage(left)};
    const auto owed_models = acknowledged.ModelsBefore(moment);
    const auto owed_requests = acknowledged.RequestsBefore(moment);
    EXPECT_TRUE(std::ranges::includes(contents.models, owed_models));
    EXPECT_TRUE(std::ranges::includes(contents.requests, owed_requests));
    window_lost_s =
        std::max(window_lost_s, acknowledged.SavedToBefore(moment) - contents.saved_to_s);
    EXPECT_EQ(contents.unreadable_chunks, 0u);
    EXPECT_FALSE(WasDamaged(left));
    models += owed_models.size();
    requests += owed_requests.size();
    std::filesystem::remove_all(left);
    if (HasFailure()) break;
  }
  std::cout << Cuts() << " cuts in " << end << " operations; models acknowledged before a cut "
            << models << ", requests " << requests << "; of the window lost, s " << window_lost_s
            << '\n';
}

}  // namespace
}  // namespace telltale
