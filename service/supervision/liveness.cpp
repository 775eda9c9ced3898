#include "telltale/service/supervision/liveness.hpp"

#include <algorithm>
#include <cstddef>

#include <spdlog/fmt/fmt.h>

namespace telltale {
namespace {

const char* RoleOf(const DaemonActivity& activity) {
  if (!activity.is_ready) return "starting with";
  return activity.serves ? "serving" : "standing by for";
}

}  // namespace

bool IsAlive(const DaemonActivity& activity) {
  return activity.ingest_silence < kLongestRound &&
         std::ranges::all_of(activity.queues, [](const QueueActivity& queue) {
           return queue.silence < kLongestStep;
         });
}

std::string StatusLine(const DaemonActivity& activity) {
  std::size_t waiting = 0;
  std::size_t running = 0;
  for (const QueueActivity& queue : activity.queues) {
    waiting += queue.waiting;
    running += queue.running;
  }
  return fmt::format("{} {} vehicles; {} requests wait, {} are worked on", RoleOf(activity),
                     activity.vehicles, waiting, running);
}

}  // namespace telltale
