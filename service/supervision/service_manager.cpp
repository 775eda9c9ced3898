#include "telltale/service/supervision/service_manager.hpp"

#include <cstdint>
#include <cstdlib>

#include <systemd/sd-daemon.h>

namespace telltale {
namespace {

constexpr int kKeepEnvironment = 0;

/// A manager that has gone away is no fault of this process.
void Tell(const std::string& message) {
  sd_notify(kKeepEnvironment, message.c_str());
}

}  // namespace

bool ServiceManager::Listens() {
  return std::getenv("NOTIFY_SOCKET") != nullptr;  // NOLINT(concurrency-mt-unsafe): nobody sets it
}

std::optional<std::chrono::microseconds> ServiceManager::LongestSilence() {
  std::uint64_t microseconds = 0;
  if (sd_watchdog_enabled(kKeepEnvironment, &microseconds) <= 0) return std::nullopt;
  return std::chrono::microseconds(microseconds);
}

void ServiceManager::TellReady() {
  Tell("READY=1");
}

void ServiceManager::TellReloading() {
  Tell("RELOADING=1");
}

void ServiceManager::TellStopping() {
  Tell("STOPPING=1");
}

void ServiceManager::TellAlive() {
  Tell("WATCHDOG=1");
}

void ServiceManager::TellStatus(const std::string& line) {
  Tell("STATUS=" + line);
}

}  // namespace telltale
