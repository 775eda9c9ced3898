#pragma once

#include <string>
#include <vector>

#include "support/run_command.hpp"

namespace telltale {

inline constexpr int kSuccess = 0;
inline constexpr int kFailure = 1;
inline constexpr int kUsage = 2;
inline constexpr int kRefused = 3;

/// Runs `telltale` with these arguments. For tests that are built with TELLTALE_COMMAND.
inline CommandOutcome Telltale(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), TELLTALE_COMMAND);
  return RunCommand(arguments);
}

}  // namespace telltale
