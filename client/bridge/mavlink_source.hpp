#pragma once

#include "telltale/client/bridge/live_source.hpp"
#include "telltale/client/bridge/mavlink_bridge.hpp"
#include "telltale/client/bridge/mavlink_link.hpp"
#include "telltale/client/bridge/utc_clock.hpp"

namespace telltale {

/// The autopilots of one MAVLink link.
class MavlinkSource : public LiveSource {
 public:
  /// Throws: std::runtime_error, as MavlinkLink does.
  MavlinkSource(const Participant& participant, const MavlinkAddress& address,
                MavlinkBridgeOptions options, Report report);

  void Run(const std::function<void()>& second) override;
  void Stop() override { link_.Stop(); }
  std::optional<std::string> Fault() const override { return link_.Fault(); }

  const MavlinkBridge& Bridge() const { return bridge_; }

 private:
  Report report_;
  UtcClock clock_;
  MavlinkLink link_;
  MavlinkBridge bridge_;
};

}  // namespace telltale
