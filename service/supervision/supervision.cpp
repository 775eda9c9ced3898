#include "telltale/service/supervision/supervision.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "telltale/service/supervision/liveness.hpp"
#include "telltale/service/supervision/service_manager.hpp"

namespace telltale {
namespace {

std::chrono::microseconds LookPeriod() {
  constexpr std::chrono::microseconds kOfStatus = std::chrono::seconds(1);
  const auto longest_silence = ServiceManager::LongestSilence();
  return longest_silence ? std::min(kOfStatus, *longest_silence / 4) : kOfStatus;
}

}  // namespace

Supervision::Supervision(std::function<DaemonActivity()> look)
    : look_(std::move(look)), thread_([this](const std::stop_token& stop) { Run(stop); }) {}

void Supervision::Run(const std::stop_token& stop) {
  const auto period = LookPeriod();
  std::unique_lock lock(mutex_);
  while (!stop.stop_requested()) {
    Look();
    wake_.wait_for(lock, stop, period, [] { return false; });
  }
}

void Supervision::Look() {
  const DaemonActivity activity = look_();
  if (activity.is_ready && !std::exchange(told_ready_, true)) ServiceManager::TellReady();
  if (const std::string status = StatusLine(activity); status != told_status_) {
    ServiceManager::TellStatus(status);
    told_status_ = status;
  }
  if (IsAlive(activity)) ServiceManager::TellAlive();
}

}  // namespace telltale
