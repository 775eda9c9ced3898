#pragma once

#include <array>
#include <map>
#include <string>

#include "telltale/client/bus/bus_log.hpp"
#include "telltale/idl/codec/daemon_config.hpp"
#include "telltale/service/ingest/rate_bound.hpp"
#include "telltale/service/ingest/vehicle_window.hpp"

namespace telltale {

/// Which samples are taken in where more come than the limits allow: SharesWithin() of what a
/// vehicle sends, then of what all send that is left. Every vehicle keeps the same share of what is
/// too much for all. The log says when that begins and ends. Not thread safe.
class Intake {
 public:
  using Clock = RateBound::Clock;

  explicit Intake(const IntakeLimits& limits);

  /// Whether the window takes in its next sample, which arrives at `now`.
  bool Admits(const VehicleWindow& window, Channel channel, Clock::time_point now);

 private:
  using Thinners = std::array<Thinner, kChannels.size()>;

  struct Stream {
    RateBound bound;
    Thinners by_own_bound{};
    Thinners by_total{};
  };

  bool Passes(RateBound& bound, Thinners& thinners, Channel channel, Clock::time_point now,
              const std::string& sender);
  void Tell(RateBound::Change change, const RateBound& bound, const std::string& sender,
            Clock::time_point now);

  IntakeLimits limits_;
  RateBound total_;
  std::map<const VehicleWindow*, Stream> streams_;
  RateLimit log_limit_;
};

}  // namespace telltale
