#pragma once

#include <atomic>
#include <cstdint>
#include <optional>

#include "telltale/client/bridge/live_source.hpp"
#include "telltale/client/bridge/ros2_bridge.hpp"
#include "telltale/client/bridge/ros2_publisher.hpp"

namespace telltale {

struct Ros2SourceOptions {
  Ros2BridgeOptions bridge;
  std::optional<std::uint32_t> domain;  ///< of ROS 2, ROS_DOMAIN_ID; unset: that of the telemetry
  bool publish = true;                  ///< models and quality, to ROS 2
};

/// The topics of ROS 2 in one domain, and what goes back to them.
class Ros2Source : public LiveSource {
 public:
  /// Requires: as Ros2Bridge. Throws BusError.
  Ros2Source(const Participant& bus, const Ros2SourceOptions& options, const Report& report);

  void Run(const std::function<void()>& second) override;
  void Stop() override;
  std::optional<std::string> Fault() const override { return std::nullopt; }

  const Ros2Bridge& Bridge() const { return bridge_; }

 private:
  std::atomic<bool> stopped_ = false;
  std::optional<Participant> own_;
  Ros2Bridge bridge_;
  std::optional<Ros2Publisher> publisher_;
};

}  // namespace telltale
