#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include <CLI/CLI.hpp>

namespace telltale {

/// What every subcommand that goes on the bus can be told.
struct LiveOptions {
  std::uint32_t domain = 0;
  double timeout_s = 0.0;

  /// `--domain`, and `--timeout` meaning what `timeout_help` says.
  void AddTo(CLI::App& command, double default_timeout_s, const std::string& timeout_help);

  std::chrono::nanoseconds Timeout() const {
    return std::chrono::ceil<std::chrono::nanoseconds>(std::chrono::duration<double>(timeout_s));
  }
};

/// `--vehicle-id`, checked.
CLI::Option* AddVehicleId(CLI::App& command, std::string& vehicle_id);

/// What to do where nobody answers on a domain.
std::string NobodyThereAdvice(std::uint32_t domain);

}  // namespace telltale
