#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "telltale/idl/codec/messages/daemon_status.hpp"

namespace telltale {

/// Which of several daemons serves, as one of them sees it. No vote is held: the daemon that serves
/// goes on, and when it is gone the others agree on the next by their order. First comes who knows
/// of the later term, since that one has followed the daemon that is gone or was that daemon; then
/// the greater ownership strength; then the greater id. Two that serve, which is possible only
/// while they cannot hear each other, agree by the same order.
///
/// A daemon whose boats and clients fall silent together with the daemon that serves is cut off
/// itself, and waits until it hears any of them, but for no more than three leases: the fleet may
/// have ended its work by chance at that time. Not thread safe.
class Election {
 public:
  using Clock = std::chrono::steady_clock;
  enum class Step { kWait, kTakeOver, kStepDown };

  /// A daemon that has just started gives those that serve a lease to be heard. `self` has the
  /// latest term that it knows of.
  Election(DaemonStatus self, Clock::duration lease, Clock::time_point now)
      : self_(std::move(self)), lease_(lease), start_(now) {}

  void Hear(const DaemonStatus& other, Clock::time_point now);
  void HearFleet(Clock::time_point now) { fleet_heard_ = now; }  ///< telemetry, or a request
  void Lose(const std::string& daemon_id) { others_.erase(daemon_id); }

  Step Decide(Clock::time_point now) const;

  /// Serves from now on, for the next term.
  void TakeOver();

  const DaemonStatus& self() const { return self_; }

  /// Whether it has heard another serve.
  bool HasFollowed() const { return server_heard_.has_value(); }

 private:
  bool IsCutOff(Clock::time_point now) const;

  DaemonStatus self_;
  Clock::duration lease_;
  Clock::time_point start_;
  std::optional<Clock::time_point> server_heard_;  ///< another that serves
  std::optional<Clock::time_point> fleet_heard_;
  std::map<std::string, DaemonStatus> others_;  ///< that are alive, by daemon id
};

}  // namespace telltale
