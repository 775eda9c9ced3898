#include "telltale/client/fleet/served_vehicles.hpp"

#include <algorithm>

#include "telltale/client/fleet/subscriber.hpp"

namespace telltale {

std::set<std::string> AwaitServed(const Participant& participant, std::set<std::string> vehicle_ids,
                                  std::chrono::nanoseconds timeout,
                                  const std::function<void(std::size_t)>& waiting) {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::nanoseconds kTell = std::chrono::milliseconds(100);
  const auto deadline = Clock::now() + timeout;
  QualitySubscriber qualities(
      participant, [&](const Quality& quality) { vehicle_ids.erase(quality.vehicle_id); },
      [](const CodecError&) {});
  for (auto left = timeout; !vehicle_ids.empty() && left > left.zero();
       left = deadline - Clock::now()) {
    qualities.Wait(std::min(left, kTell));
    if (waiting) waiting(vehicle_ids.size());
  }
  return vehicle_ids;
}

}  // namespace telltale
