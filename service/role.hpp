#pragma once

#include <chrono>
#include <mutex>
#include <optional>

namespace telltale {

/// Whether this daemon serves: answers requests and publishes. It may do so for a lease, which its
/// working loop renews. A lease that has run out is lost for good: another daemon may serve by
/// then, and this one may have been suspended. Thread safe.
class Role {
 public:
  using Clock = std::chrono::steady_clock;

  /// Without a lease the daemon serves from the start, for ever.
  explicit Role(std::optional<Clock::duration> lease)
      : lease_(lease), ends_(lease ? Clock::time_point::min() : Clock::time_point::max()) {}

  void Assume(Clock::time_point now);
  void Renew(Clock::time_point now);
  void Resign();
  bool Serves(Clock::time_point now = Clock::now()) const;

 private:
  void Prolong(Clock::time_point now) {
    if (lease_) ends_ = now + *lease_;
  }

  const std::optional<Clock::duration> lease_;
  mutable std::mutex mutex_;  // of ends_
  Clock::time_point ends_;
};

}  // namespace telltale
