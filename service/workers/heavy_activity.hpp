#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace telltale {

/// The heavy jobs of one queue: those of now, and those since the daemon started.
struct HeavyActivity {
  std::string queue;                ///< "identification", "diagnosis"
  std::size_t waiting = 0;          ///< offered, and no worker has taken them
  std::size_t taken = 0;            ///< that a worker computes
  std::uint64_t answered = 0;       ///< that a worker has computed
  std::uint64_t given_up = 0;       ///< that no worker has finished
  std::uint64_t computed_here = 0;  ///< since no worker was alive
};

}  // namespace telltale
