#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>

namespace telltale {

/// How often a store has written since the daemon started, and how long that took together. Safe
/// to use from several threads.
class WriteDurations {
 public:
  struct Sum {
    std::uint64_t writes = 0;
    double duration_s = 0.0;
  };

  /// Runs a write and counts it, also where it throws. Returns what the write returns.
  template <class Write>
  auto Count(Write write) {
    const Stopwatch stopwatch(*this);
    return write();
  }

  Sum Total() const {
    const std::lock_guard lock(mutex_);
    return total_;
  }

 private:
  using Clock = std::chrono::steady_clock;

  class Stopwatch {
   public:
    explicit Stopwatch(WriteDurations& durations) : durations_(durations) {}
    Stopwatch(const Stopwatch&) = delete;
    Stopwatch& operator=(const Stopwatch&) = delete;
    ~Stopwatch() {
      const std::chrono::duration<double> passed = Clock::now() - begun_;
      const std::lock_guard lock(durations_.mutex_);
      ++durations_.total_.writes;
      durations_.total_.duration_s += passed.count();
    }

   private:
    WriteDurations& durations_;
    Clock::time_point begun_ = Clock::now();
  };

  mutable std::mutex mutex_;  // of total_
  Sum total_;
};

}  // namespace telltale
