#pragma once

#include <string>
#include <vector>

#include "support/run_command.hpp"

namespace telltale {

inline constexpr int kExitSuccess = 0;
inline constexpr int kExitFailure = 1;
inline constexpr int kExitUsage = 2;
inline constexpr int kExitRefused = 3;

/// Runs `telltale` with these arguments. For tests that are built with TELLTALE_COMMAND.
inline CommandOutcome Telltale(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), TELLTALE_COMMAND);
  return RunCommand(arguments);
}

}  // namespace telltale
