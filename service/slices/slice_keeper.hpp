#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

#include "telltale/service/slices/slice_leases.hpp"
#include "telltale/service/storage/held_slices.hpp"

namespace telltale {

/// How a daemon means to have the fleet.
enum class FleetShare {
  kPart,  ///< as much as the other daemons. Leases that ran out while the database could not be
          ///< reached are given up, since others may hold them.
  kAll,   ///< all of it; nobody else is meant to hold any
};

/// Keeps the share of the fleet that is due to this daemon, on a thread of its own: it renews the
/// leases four times as often as they run out, takes slices that nobody holds up to its share, and
/// gives up what is beyond, so that others that come get theirs.
class SliceKeeper {
 public:
  /// `changed` runs on another thread whenever `held` has changed, and is to serve the boats of
  /// these slices and no others. A slice is given up after `changed` has returned.
  SliceKeeper(SliceLeases& leases, HeldSlices& held, FleetShare wanted,
              std::function<void()> changed);
  SliceKeeper(const SliceKeeper&) = delete;
  SliceKeeper& operator=(const SliceKeeper&) = delete;
  ~SliceKeeper();  ///< ends the threads; the leases stay

 private:
  using Clock = std::chrono::steady_clock;

  void Keep();
  void Turn();
  Slices Share();
  int Due();
  void ReleaseWhatIsNotServed(const Slices& renewed);
  void Hold(const Slices& slices);
  void Apply();

  SliceLeases& leases_;
  HeldSlices& held_;
  const FleetShare wanted_;
  const std::function<void()> changed_;
  Clock::time_point run_out_;
  bool reached_last_time_ = true;

  std::mutex mutex_;  // of what follows
  std::condition_variable wake_;
  bool stopping_ = false;
  Slices to_apply_;
  Slices applied_;
  std::thread keeping_;
  std::thread applying_;
};

}  // namespace telltale
