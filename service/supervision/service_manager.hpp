#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace telltale {

/// What the service manager that started this process is told, by the protocol of sd_notify(3):
/// systemd for a unit of Type=notify, and others. Where none listens each call does nothing.
class ServiceManager {
 public:
  /// Whether one listens: NOTIFY_SOCKET of the environment names it.
  static bool Listens();

  /// The longest time between two signs of life, by WATCHDOG_USEC; nothing: none are awaited.
  static std::optional<std::chrono::microseconds> LongestSilence();

  static void TellReady();
  static void TellReloading();  ///< until TellReady()
  static void TellStopping();
  static void TellAlive();
  static void TellStatus(const std::string& line);
};

}  // namespace telltale
