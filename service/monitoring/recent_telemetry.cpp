#include "telltale/service/monitoring/recent_telemetry.hpp"

#include <algorithm>
#include <numeric>

namespace telltale {
namespace {

constexpr std::chrono::seconds kMinute{60};
constexpr std::chrono::seconds kBetweenCounts{5};

std::uint64_t OfAllChannels(const std::array<std::uint64_t, kChannels.size()>& counts) {
  return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
}

double Share(std::uint64_t part, std::uint64_t whole) {
  if (whole == 0) return 0.0;
  return std::min(static_cast<double>(part) / static_cast<double>(whole), 1.0);
}

RejectCounts RejectedBetween(const RejectCounts& then, const RejectCounts& now) {
  RejectCounts between;
  for (const Channel channel : kChannels) {
    for (const RejectReason reason : kRejectReasons) {
      const std::uint64_t before = then.Of(channel, reason);
      between.Count(channel, reason, std::max(now.Of(channel, reason), before) - before);
    }
  }
  return between;
}

}  // namespace

double LastMinute::SilentS() const {
  return *std::min_element(silent_s.begin(), silent_s.end());
}

double LastMinute::LossShare() const {
  return Share(lost, arrived + lost);
}

double LastMinute::RejectShare() const {
  return Share(rejected.Total(), arrived);
}

double LastMinute::ShedShare() const {
  return Share(shed, arrived);
}

void RecentTelemetry::Note(const WindowState& state, Clock::time_point now) {
  for (std::size_t i = 0; i < kChannels.size(); ++i) {
    const bool first = !newest_;
    if (first || state.arrived[i] != newest_->state.arrived[i]) arrived_at_[i] = now;
  }
  newest_ = Counts{now, state};
  if (kept_.empty() || now >= kept_.back().at + kBetweenCounts) kept_.push_back(*newest_);
  while (kept_.size() > 1 && kept_[1].at <= now - kMinute) kept_.pop_front();
}

LastMinute RecentTelemetry::Summary() const {
  LastMinute last;
  if (!newest_) return last;
  const WindowState& then = kept_.front().state;
  const WindowState& now = newest_->state;
  for (std::size_t i = 0; i < kChannels.size(); ++i) {
    last.silent_s[i] = std::chrono::duration<double>(newest_->at - arrived_at_[i]).count();
  }
  last.ever_arrived = OfAllChannels(now.arrived) > 0;
  last.arrived = OfAllChannels(now.arrived) - OfAllChannels(then.arrived);
  last.shed = OfAllChannels(now.shed) - OfAllChannels(then.shed);
  last.lost = std::max(now.lost, then.lost) - then.lost;
  last.clock_jumps = std::max(now.clock_jumps, then.clock_jumps) - then.clock_jumps;
  last.rejected = RejectedBetween(then.rejected, now.rejected);
  return last;
}

}  // namespace telltale
