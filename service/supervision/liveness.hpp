#pragma once

#include <chrono>
#include <string>

#include "telltale/service/monitoring/daemon_activity.hpp"

namespace telltale {

/// The longest time between two rounds of the ingest loop, which comes round every second or two.
inline constexpr std::chrono::seconds kLongestRound{5};

/// The longest step of a computation between two reports of progress, with the processors full of
/// more urgent work: of a coverage check at nice 19 some minutes.
inline constexpr std::chrono::minutes kLongestStep{30};

/// Whether the threads of a daemon advance: its ingest loop comes round, and each request that is
/// worked on reports progress.
bool IsAlive(const DaemonActivity& activity);

/// A line for people: "serving 12 vehicles; 3 requests wait, 1 are worked on".
std::string StatusLine(const DaemonActivity& activity);

}  // namespace telltale
