#include "telltale/service/standby/election.hpp"

#include <algorithm>
#include <tuple>

namespace telltale {
namespace {

/// Those that serve come before those that do not.
bool Precedes(const DaemonStatus& one, const DaemonStatus& other) {
  const auto rank = [](const DaemonStatus& status) {
    return std::tie(status.serves, status.term, status.ownership_strength, status.daemon_id);
  };
  return rank(one) > rank(other);
}

constexpr int kCutOffLeases = 3;

}  // namespace

void Election::Hear(const DaemonStatus& other, Clock::time_point now) {
  others_.insert_or_assign(other.daemon_id, other);
  if (!other.serves || self_.serves) return;
  self_.term = std::max(self_.term, other.term);
  server_heard_ = now;
}

/// Each is heard several times a lease while it is alive.
bool Election::IsCutOff(Clock::time_point now) const {
  if (!server_heard_ || !fleet_heard_) return false;
  const auto silence = now - *server_heard_;
  const bool server_fell_silent = silence > 0.9 * lease_ && silence < kCutOffLeases * lease_;
  return server_fell_silent && std::chrono::abs(*fleet_heard_ - *server_heard_) < 0.3 * lease_;
}

Election::Step Election::Decide(Clock::time_point now) const {
  const bool comes_first = std::ranges::none_of(
      others_, [this](const auto& other) { return Precedes(other.second, self_); });
  if (self_.serves) return comes_first ? Step::kWait : Step::kStepDown;
  const bool has_listened = HasFollowed() || now >= start_ + lease_;
  return comes_first && has_listened && !IsCutOff(now) ? Step::kTakeOver : Step::kWait;
}

void Election::TakeOver() {
  self_.serves = true;
  self_.term = std::min(self_.term + 1, kHighestTerm);
}

}  // namespace telltale
