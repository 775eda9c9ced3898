#pragma once

#include <chrono>
#include <cstdint>

#include "telltale/service/monitoring/daemon_activity.hpp"

namespace telltale {

/// Whether the threads of a daemon advance, by what it says of itself at one look after another.
/// The ingest thread advances where its loop has come round since the last look at which all
/// advanced. A worker advances while it has no request, and while its computation reports progress.
class Liveness {
 public:
  /// The longest step of a computation between two reports of progress, with the processors full of
  /// more urgent work: of a coverage check at nice 19 some minutes.
  static constexpr std::chrono::minutes kLongestStep{30};

  bool Advances(const DaemonActivity& activity);

 private:
  std::uint64_t heartbeats_ = 0;  ///< at the last look at which all advanced
};

}  // namespace telltale
