#pragma once

#include <string>

#include "telltale/core/base/result.hpp"

namespace telltale {

/// What the command exits with.
enum class ExitCode : int {
  kSuccess = 0,
  kFailure = 1,  ///< a file, the network, the daemon
  kUsage = 2,    ///< the command line
  kRefused = 3,  ///< the data cannot answer
};

/// "subject: reason" and, on a line of its own, what to do about it; wrapped for a terminal.
std::string Explained(const Refusal& refusal);

}  // namespace telltale
