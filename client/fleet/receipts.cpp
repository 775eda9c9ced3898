#include "telltale/client/fleet/receipts.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace telltale {
namespace {

using Clock = std::chrono::steady_clock;

/// Reports come in rounds, and the first may be joined half-way.
constexpr int kRoundsUntilUnserved = 2;

/// Both sides know of each other already; a new reader is connected well within this.
constexpr auto kMatchTime = std::chrono::seconds(1);
constexpr auto kPoll = std::chrono::milliseconds(100);

std::uint64_t RejectedTotal(const Quality& quality) {
  return std::accumulate(
      quality.rejected.begin(), quality.rejected.end(), std::uint64_t{0},
      [](std::uint64_t sum, const RejectEntry& entry) { return sum + entry.count; });
}

}  // namespace

Receipts::Receipts(const Participant& participant, std::string vehicle_id)
    : vehicle_id_(std::move(vehicle_id)),
      qualities_(
          participant, [this](const Quality& quality) { Take(quality); },
          [](const CodecError&) {}) {}

void Receipts::Take(const Quality& quality) {
  if (quality.vehicle_id == kUnattributed) ++rounds_without_;
  if (quality.vehicle_id != vehicle_id_) return;
  rounds_without_ = 0;
  const std::uint64_t shed =
      std::accumulate(quality.shed.begin(), quality.shed.end(), std::uint64_t{0});
  const std::uint64_t total = quality.accepted + RejectedTotal(quality) + quality.lost + shed;
  if (!begun_at_) {
    begun_at_ = total;
    lost_before_ = lost_ = quality.lost;
    shed_before_ = shed;
  }
  if (total < total_) return;  // a second daemon, whose counts began later
  // What was written off and then seen to be missing is lost once.
  written_off_ -= std::min(written_off_, quality.lost - std::min(lost_, quality.lost));
  lost_ = std::max(lost_, quality.lost);
  shed_ = shed;
  total_ = total;
}

bool Receipts::Begin(std::chrono::nanoseconds timeout) {
  const auto start = Clock::now();
  while (!begun_at_ && rounds_without_ < kRoundsUntilUnserved) {
    const auto elapsed = Clock::now() - start;
    if (elapsed >= timeout || (elapsed >= kMatchTime && !qualities_.Connected())) return false;
    qualities_.Wait(kPoll);
  }
  return begun_at_.has_value();
}

bool Receipts::WaitFor(std::uint64_t count, std::chrono::nanoseconds patience) {
  auto deadline = Clock::now() + patience;
  while (Accounted() < count) {
    const std::uint64_t before = Accounted();
    const auto left = deadline - Clock::now();
    if (left <= left.zero() || !qualities_.Connected()) return false;
    qualities_.Wait(left);
    if (Accounted() != before) deadline = Clock::now() + patience;
  }
  return true;
}

}  // namespace telltale
