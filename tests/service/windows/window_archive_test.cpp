#include "telltale/service/windows/window_archive.hpp"

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>

#include "support/temporary_folder.hpp"

namespace telltale {
namespace {

using namespace std::chrono_literals;

/// What the log says, for as long as it stands.
class HeardLog {
 public:
  HeardLog() : former_(spdlog::default_logger()) {
    spdlog::set_default_logger(std::make_shared<spdlog::logger>("heard", sink_));
  }
  HeardLog(const HeardLog&) = delete;
  HeardLog& operator=(const HeardLog&) = delete;
  ~HeardLog() { spdlog::set_default_logger(former_); }

  bool Await(std::string_view text) { return sink_->Await(text); }

 private:
  class Sink : public spdlog::sinks::base_sink<std::mutex> {
   public:
    bool Await(std::string_view text) {
      std::unique_lock lock(heard_mutex_);
      return heard_.wait_for(lock, 60s, [&] { return text_.find(text) != std::string::npos; });
    }

   private:
    void sink_it_(const spdlog::details::log_msg& message) override {
      {
        const std::lock_guard lock(heard_mutex_);
        text_.append(message.payload.data(), message.payload.size());
      }
      heard_.notify_all();
    }
    void flush_() override {}

    std::mutex heard_mutex_;
    std::condition_variable heard_;
    std::string text_;
  };

  std::shared_ptr<spdlog::logger> former_;
  std::shared_ptr<Sink> sink_ = std::make_shared<Sink>();
};

Vehicle Boat() {
  Vehicle vehicle;
  vehicle.vehicle_id = "boat";
  return vehicle;
}

std::size_t SavedFixes(const TemporaryFolder& folder) {
  std::size_t fixes = 0;
  WindowStore(Storage(folder.Path())).Load("boat", [&](const Recording& samples) {
    fixes += samples.gnss.size();
  });
  return fixes;
}

TEST(WindowArchive, SavesLaterWhatTheDiskRefused) {
  HeardLog log;
  const TemporaryFolder folder;
  Fleet fleet({Boat()}, WindowLimits());
  VehicleWindow& window = *fleet.Find("boat");
  {
    WindowArchive archive(WindowStore(Storage(folder.Path())), fleet, {600.0, 0.01, 0.0});
    SQLite::Database disk(folder.Path() / "windows.sqlite", SQLite::OPEN_READWRITE);
    disk.setBusyTimeout(5000);
    disk.exec(
        "CREATE TRIGGER refuse BEFORE INSERT ON chunks BEGIN SELECT RAISE(ABORT, 'full'); END");
    window.Add(1, GnssFix{100.0, 37.0, -6.0});
    ASSERT_TRUE(log.Await("taken in and not saved"));
    disk.exec("DROP TRIGGER refuse");
    window.Add(2, GnssFix{100.2, 37.0, -6.0});
    ASSERT_TRUE(log.Await("windows are saved again"));
  }
  EXPECT_EQ(SavedFixes(folder), 2u);
}

/// More than a window of the least memory holds, in the ten minutes that it spans.
TEST(WindowArchive, BoundsWhatWaitsForADatabaseThatHangsAndSavesTheNewest) {
  HeardLog log;
  const TemporaryFolder folder;
  Fleet fleet({Boat()}, WindowLimits(), WindowLimits::kLeastMemory);
  VehicleWindow& window = *fleet.Find("boat");
  constexpr std::size_t kMost = WindowLimits::kLeastMemory / sizeof(GnssFix);
  constexpr int kFixes = 10'000;
  static_assert(kFixes > 2 * kMost);
  {
    WindowArchive archive(WindowStore(Storage(folder.Path())), fleet, {600.0, 0.01, 0.0});
    SQLite::Database disk(folder.Path() / "windows.sqlite", SQLite::OPEN_READWRITE);
    disk.setBusyTimeout(5000);
    disk.exec("BEGIN EXCLUSIVE");  // who writes waits
    for (int i = 0; i < kFixes; ++i) {
      window.Add(0, GnssFix{0.05 * i, 37.0 + 1e-7 * i, -6.0});
      ASSERT_LE(archive.Activity().samples.unsaved, kMost);
    }
    EXPECT_GT(archive.Activity().samples.dropped, 0u);
    disk.exec("ROLLBACK");
    ASSERT_TRUE(log.Await("have gone before they were saved"));
  }
  EXPECT_GE(SavedFixes(folder), kMost * 3 / 4);
  double newest_s = 0.0;
  WindowStore(Storage(folder.Path())).Load("boat", [&](const Recording& samples) {
    newest_s = samples.gnss.back().time_s;
  });
  EXPECT_EQ(newest_s, 0.05 * (kFixes - 1));
}

}  // namespace
}  // namespace telltale
