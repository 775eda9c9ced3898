#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>

namespace telltale {

/// The requests of one queue: those of now, and those turned away since the daemon started.
struct QueueActivity {
  std::string queue;        ///< "identification", "diagnosis"
  std::size_t waiting = 0;  ///< requests that no worker has begun
  std::size_t running = 0;  ///< requests that are worked on
  std::size_t workers = 0;  ///< of all urgencies
  /// Since the last report of progress of a request that is worked on; of the longest silent one.
  std::chrono::steady_clock::duration silence{0};
  std::uint64_t shed = 0;  ///< requests that found the queue or their client's share full
};

}  // namespace telltale
