#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>

#include "telltale/core/data/samples.hpp"
#include "telltale/service/ingest/vehicle_window.hpp"

namespace telltale {

/// What became of one vehicle's samples in the last minute, by the daemon's clock.
struct LastMinute {
  bool ever_arrived = false;                        ///< any sample since the daemon started
  std::array<double, kChannels.size()> silent_s{};  ///< gnss, heading, thrusters
  std::uint64_t arrived = 0;
  std::uint64_t lost = 0;
  std::uint64_t shed = 0;         ///< of those that arrived
  std::uint64_t clock_jumps = 0;  ///< of the vehicle's clock
  RejectCounts rejected;

  /// Since the newest sample of any channel.
  double SilentS() const;
  /// Of the samples sent; 0 where none was.
  double LossShare() const;
  /// Of the samples that arrived; 0 where none did.
  double RejectShare() const;
  /// Likewise.
  double ShedShare() const;
};

/// Remembers the counts of one vehicle for a minute. Not thread safe.
class RecentTelemetry {
 public:
  using Clock = std::chrono::steady_clock;

  /// Adds the counts of now. Requires: not earlier than those before.
  void Note(const WindowState& state, Clock::time_point now);

  /// The last minute up to the newest counts noted.
  LastMinute Summary() const;

 private:
  struct Counts {
    Clock::time_point at;
    WindowState state;
  };

  std::deque<Counts> kept_;  ///< oldest first, five seconds apart; the first is a minute old
  std::optional<Counts> newest_;
  std::array<Clock::time_point, kChannels.size()> arrived_at_{};
};

}  // namespace telltale
