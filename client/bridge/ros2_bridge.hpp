#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "telltale/client/bridge/live_ros_vehicle.hpp"
#include "telltale/client/bridge/ros2_names.hpp"
#include "telltale/client/bridge/utc_clock.hpp"
#include "telltale/client/bus/participant.hpp"
#include "telltale/client/bus/publication_reader.hpp"
#include "telltale/client/bus/serialized_reader.hpp"
#include "telltale/client/bus/wait_set.hpp"
#include "telltale/client/fleet/telemetry_publisher.hpp"

namespace telltale {

struct Ros2BridgeOptions {
  std::string name_space;  ///< empty: "/{vehicle}", or "/" where the vehicle id has no {vehicle}
  std::string vehicle_id = kVehiclePlaceholder;
  SourceOptions source;  ///< a mapping, or the channels of RCOut
  ChannelChoice channels;

  /// The pattern of namespaces that counts.
  std::string Namespace() const;

  /// The first fault, with what is allowed: of the namespace, of the id, or of their {vehicle},
  /// which stands in both or in neither.
  std::optional<std::string> Fault() const;
};

/// What has gone through of one vehicle, since it was first heard.
struct RosVehicleCounts {
  std::string vehicle_id;
  std::array<std::uint64_t, kChannels.size()> published{};
  std::array<std::uint64_t, kRosRejects.size()> rejected{};
};

/// Carries topics of ROS 2 onto the telemetry of the bus: it finds them by their names, reads them
/// best effort, which takes either kind of publisher, and needs no ROS. At most a thousand
/// vehicles.
class Ros2Bridge {
 public:
  using Report = std::function<void(const std::string& what)>;

  /// `ros`: in the domain of the topics; `bus`: in that of the telemetry; they may be one.
  /// Requires: options.Fault() and options.source.Validate() are empty. Throws BusError.
  Ros2Bridge(const Participant& ros, const Participant& bus, Ros2BridgeOptions options,
             Report report);
  Ros2Bridge(const Ros2Bridge&) = delete;
  Ros2Bridge& operator=(const Ros2Bridge&) = delete;

  /// Takes what arrives within `timeout`. Any thread may end it by Wake().
  void Wait(std::chrono::nanoseconds timeout) { wait_set_.Wait(timeout); }
  void Wake() { wait_set_.Wake(); }

  std::vector<RosVehicleCounts> Counts() const;

 private:
  struct Vehicle {
    Vehicle(const Participant& bus, const std::string& id, const Ros2BridgeOptions& options,
            const Report& report);

    TelemetryPublisher publisher;
    LiveRosVehicle live;
  };

  void Discover(const Publication& publication);
  Vehicle* VehicleOf(const std::string& topic);

  const Participant& ros_;
  const Participant& bus_;
  const Ros2BridgeOptions options_;
  Report report_;
  UtcClock clock_;
  std::map<std::string, std::unique_ptr<Vehicle>> vehicles_;  ///< by id
  std::set<std::string> left_out_;                            ///< ids that are none, or too many
  WaitSet wait_set_;
  PublicationReader publications_;
  std::map<std::pair<std::string, std::string>, SerializedReader> readers_;  ///< by topic and type
};

}  // namespace telltale
