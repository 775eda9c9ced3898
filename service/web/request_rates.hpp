#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>

namespace telltale {

/// Counts the requests of each client of the last begun minute against a limit. It knows a bounded
/// number of clients; those beyond it share one count. Safe to use from several threads.
class RequestRates {
 public:
  using Clock = std::chrono::steady_clock;

  explicit RequestRates(std::uint64_t most_per_minute) : most_(most_per_minute) {}

  /// Takes a request in, or says how long its client is to wait.
  std::optional<std::chrono::seconds> Wait(const std::string& client, Clock::time_point now);

  std::uint64_t most() const { return most_; }

 private:
  static constexpr std::size_t kMostClients = 1024;

  const std::uint64_t most_;
  std::mutex mutex_;  // of what follows
  Clock::time_point minute_ends_;
  std::unordered_map<std::string, std::uint64_t> requests_;  ///< by client; "": of the others
};

}  // namespace telltale
