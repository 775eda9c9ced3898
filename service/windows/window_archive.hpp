#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "telltale/service/ingest/fleet.hpp"
#include "telltale/service/storage/write_durations.hpp"
#include "telltale/service/windows/window_store.hpp"

namespace telltale {

/// Keeps the windows of the fleet in the storage: it fills them at start with what the store holds,
/// and saves what they take in once a period, on a thread of its own, and at the end. A fault of
/// the database is logged, and the next period tries again: what is not saved waits in memory, no
/// longer than a window lasts.
class WindowArchive {
 public:
  /// Fills the windows before it returns. Assumes that nothing else fills them yet.
  WindowArchive(WindowStore store, Fleet& fleet, double window_s, double period_s);
  WindowArchive(const WindowArchive&) = delete;
  WindowArchive& operator=(const WindowArchive&) = delete;
  ~WindowArchive();  ///< saves and ends the thread

  /// Fills the window of a vehicle that is served from now on, and saves it too. Where the database
  /// refuses, the log says so and the window begins empty.
  void Admit(const std::string& vehicle_id, VehicleWindow& window);

  WriteDurations::Sum Written() const { return written_.Total(); }

 private:
  void Restore();
  void Restore(const std::string& vehicle_id, VehicleWindow& window);
  void Run();
  void Save();
  void TakeRound();
  void SaveRounds();

  WindowStore store_;
  WriteDurations written_;
  Fleet& fleet_;
  const double window_s_;
  const std::int64_t most_chunks_;
  const std::chrono::duration<double> period_;
  const std::size_t most_rounds_;
  std::deque<std::vector<WindowStore::Chunk>> rounds_;  // one a period, not saved yet
  bool saved_last_time_ = true;
  std::mutex store_mutex_;  // of store_
  std::mutex mutex_;        // of stopping_
  std::condition_variable wake_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace telltale
