#include "telltale/service/supervision/liveness.hpp"

#include <algorithm>

namespace telltale {

bool Liveness::Advances(const DaemonActivity& activity) {
  if (activity.heartbeats == heartbeats_) return false;
  const bool workers_advance = std::ranges::all_of(
      activity.queues, [](const QueueActivity& queue) { return queue.silence < kLongestStep; });
  if (workers_advance) heartbeats_ = activity.heartbeats;
  return workers_advance;
}

}  // namespace telltale
