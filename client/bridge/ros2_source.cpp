#include "telltale/client/bridge/ros2_source.hpp"

#include <chrono>

namespace telltale {
namespace {

std::optional<Participant> OwnParticipant(const std::optional<std::uint32_t>& domain) {
  return domain ? std::optional<Participant>(*domain) : std::nullopt;
}

}  // namespace

Ros2Source::Ros2Source(const Participant& bus, const Ros2SourceOptions& options,
                       const Report& report)
    : own_(OwnParticipant(options.domain)),
      bridge_(own_ ? *own_ : bus, bus, options.bridge, report) {
  if (options.publish) publisher_.emplace(own_ ? *own_ : bus, bus, report);
}

void Ros2Source::Run(const std::function<void()>& second) {
  using Clock = std::chrono::steady_clock;
  constexpr auto kPeriod = std::chrono::seconds(1);
  const UtcClock clock;
  auto next = Clock::now() + kPeriod;
  while (!stopped_) {
    bridge_.Wait(next - Clock::now());
    if (Clock::now() < next) continue;
    next = Clock::now() + kPeriod;
    if (publisher_) publisher_->EachSecond(clock.Now());
    second();
  }
}

void Ros2Source::Stop() {
  stopped_ = true;
  bridge_.Wake();
}

}  // namespace telltale
