#pragma once

#include <string>

#include "telltale/client/bus/bus_log.hpp"
#include "telltale/idl/codec/daemon_config.hpp"
#include "telltale/service/ingest/rate_bound.hpp"

namespace telltale {

/// Which samples are taken in where more come than the limits allow: SharesWithin() of what a
/// vehicle sends, then of what all send that is left. Every vehicle keeps the same share of what is
/// too much for all. The log says when that begins and ends. Not thread safe.
class Intake {
 public:
  using Clock = RateBound::Clock;

  /// What is known of one vehicle's samples.
  struct Stream {
    RateBound bound;
    ChannelThinners by_own_bound{};
    ChannelThinners by_total{};
  };

  explicit Intake(const IntakeLimits& limits);

  Stream NewStream() const { return {RateBound(limits_.vehicle_samples_per_s)}; }

  /// Whether the next sample of the vehicle's stream, which arrives at `now`, is taken in.
  bool Admits(Stream& stream, const std::string& vehicle_id, Channel channel,
              Clock::time_point now);

 private:
  bool Passes(RateBound& bound, ChannelThinners& thinners, Channel channel, Clock::time_point now,
              const std::string& sender);
  void Tell(RateBound::Change change, const RateBound& bound, const std::string& sender,
            Clock::time_point now);

  IntakeLimits limits_;
  RateBound total_;
  RateLimit log_limit_;
};

}  // namespace telltale
