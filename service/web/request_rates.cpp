#include "telltale/service/web/request_rates.hpp"

namespace telltale {

std::optional<std::chrono::seconds> RequestRates::Wait(const std::string& client,
                                                       Clock::time_point now) {
  const std::lock_guard lock(mutex_);
  if (now >= minute_ends_) {
    requests_.clear();
    minute_ends_ = now + std::chrono::minutes(1);
  }
  const bool has_place = requests_.size() < kMostClients || requests_.contains(client);
  if (++requests_[has_place ? client : ""] <= most_) return std::nullopt;
  return std::chrono::ceil<std::chrono::seconds>(minute_ends_ - now);
}

}  // namespace telltale
