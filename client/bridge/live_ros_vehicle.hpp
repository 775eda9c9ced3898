#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "telltale/client/bridge/channel_choice.hpp"
#include "telltale/client/bridge/live_ros_topics.hpp"
#include "telltale/client/recording/mapping/mapped_samples.hpp"
#include "telltale/client/recording/ros/message_definition.hpp"
#include "telltale/client/recording/time_order.hpp"

namespace telltale {

/// Turns the ROS 2 topics of one vehicle into telemetry, message by message: by a mapping where one
/// is given, whose times count as they are, else by the rules of LiveRosTopics.
class LiveRosVehicle {
 public:
  using Publish = std::function<void(const RawSample&)>;
  using Report = std::function<void(const std::string& what)>;

  /// Requires: options.Validate() is empty.
  LiveRosVehicle(const SourceOptions& options, Publish publish, const Report& report,
                 ChannelChoice choice = {});
  LiveRosVehicle(const LiveRosVehicle&) = delete;
  LiveRosVehicle& operator=(const LiveRosVehicle&) = delete;

  /// One message, and when it arrived, in UTC seconds by a clock that never goes back.
  void Take(std::string_view topic, std::string_view type, std::span<const std::uint8_t> bytes,
            double arrival_s);

  std::uint64_t Published(Channel channel) const {
    return published_[static_cast<std::size_t>(channel)];
  }
  std::uint64_t Rejected(RosReject reason) const {
    return rejected_[static_cast<std::size_t>(reason)];
  }

 private:
  void Deliver(Channel channel, const RawSample& sample);
  void Count(RosReject reason) { ++rejected_[static_cast<std::size_t>(reason)]; }
  void TakeMapped(std::string_view topic, std::string_view type,
                  std::span<const std::uint8_t> bytes, double arrival_s);

  ChannelChoice choice_;
  Publish publish_;
  std::array<std::uint64_t, kChannels.size()> published_{};
  std::array<std::uint64_t, kRosRejects.size()> rejected_{};
  SideJoiner joiner_;
  bool made_sample_ = false;  ///< by the message that is being taken
  RosMessageTypes types_;
  std::shared_ptr<const Mapping> mapping_;
  std::optional<MappedSamples> mapped_;
  std::optional<LiveRosTopics> by_rules_;
};

/// Whether a vehicle would take messages of this topic, by the same options.
bool NamesRosTopic(const SourceOptions& options, std::string_view topic, std::string_view type);

}  // namespace telltale
