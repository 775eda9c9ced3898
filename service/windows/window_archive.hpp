#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "telltale/service/ingest/fleet.hpp"
#include "telltale/service/storage/write_durations.hpp"
#include "telltale/service/windows/window_store.hpp"

namespace telltale {

/// How the windows of the fleet stand to the store.
struct WindowActivity {
  std::size_t unloaded = 0;  ///< windows whose samples are in the store alone
  SavingState samples;       ///< of all windows together
};

/// Keeps the windows of the fleet in the storage: it fills them at start with what the store holds,
/// and saves what they take in once a period, on a thread of its own, and at the end. A fault of
/// the database is logged, and the next period tries again: what is not saved waits in the windows,
/// within their bounds of memory; beside it waits what could not be written last. A window that is
/// not used for a while is unloaded once it is saved. The first sample brings it back, on the same
/// thread, and so does who asks for its samples.
class WindowArchive {
 public:
  struct Periods {
    double window_s = 0.0;        ///< what a window spans
    double save_s = 0.0;          ///< from save to save
    double unload_after_s = 0.0;  ///< without a sample or a reader; 0: never
  };

  /// Fills the windows before it returns. Assumes that nothing else fills them yet.
  WindowArchive(WindowStore store, Fleet& fleet, const Periods& periods);
  WindowArchive(const WindowArchive&) = delete;
  WindowArchive& operator=(const WindowArchive&) = delete;
  ~WindowArchive();  ///< saves and ends the thread

  /// Fills the window of a vehicle that is served from now on, and saves it too. Where the database
  /// refuses, the log says so and the window begins empty.
  void Admit(const std::string& vehicle_id, VehicleWindow& window);

  WriteDurations::Sum Written() const { return written_.Total(); }
  WindowActivity Activity() const;

 private:
  using Clock = std::chrono::steady_clock;

  void Restore();
  void Read(const std::string& vehicle_id, const std::function<void(const Recording&)>& take);
  void Run();
  void Save();
  void TakeUnsaved();
  void Write();
  void LogDropped();
  void UnloadUnused();
  bool LoadWanted();
  void Want();

  WindowStore store_;
  WriteDurations written_;
  Fleet& fleet_;
  const Periods periods_;
  const std::int64_t most_chunks_;
  /// Taken from the windows, and not saved yet: those of a group together.
  std::deque<std::vector<WindowStore::Chunk>> chunks_;
  bool saved_last_time_ = true;
  bool loaded_last_time_ = true;
  std::uint64_t dropped_ = 0;  ///< samples, as last logged
  std::mutex store_mutex_;     // of store_
  std::mutex mutex_;           // of what follows
  std::condition_variable wake_;
  bool load_wanted_ = false;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace telltale
