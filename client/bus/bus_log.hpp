#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>

#include <spdlog/spdlog.h>

namespace telltale {

/// Lets at most `limit` events of every period through and counts the others.
class RateLimit {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  RateLimit(std::uint64_t limit, std::chrono::nanoseconds period)
      : limit_(limit), period_(period) {}

  /// Nothing when the event is to be held back, else how many were held back since the last that
  /// was let through.
  std::optional<std::uint64_t> Admit(TimePoint now);

 private:
  std::uint64_t limit_;
  std::chrono::nanoseconds period_;
  std::optional<TimePoint> period_start_;
  std::uint64_t admitted_ = 0;
  std::uint64_t held_back_ = 0;
};

/// Sends what Cyclone DDS has to say to `logger`, at most 20 lines in ten seconds: under malformed
/// packets it writes hundreds of thousands. Install before the first participant; one per process.
class BusLog {
 public:
  /// Told the topic of each sample that could not be deserialised, from threads of the bus; it must
  /// return at once. Cyclone DDS tells of such samples in its log and nowhere else.
  using UnreadableHandler = std::function<void(std::string_view topic)>;

  explicit BusLog(std::shared_ptr<spdlog::logger> logger, UnreadableHandler unreadable = {});
  BusLog(const BusLog&) = delete;
  BusLog& operator=(const BusLog&) = delete;
  ~BusLog();

 private:
  struct Sink;
  std::unique_ptr<Sink> sink_;
};

}  // namespace telltale
