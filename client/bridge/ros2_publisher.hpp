#pragma once

#include <functional>
#include <map>
#include <string>

#include "telltale/client/bus/participant.hpp"
#include "telltale/client/bus/ros_writer.hpp"
#include "telltale/client/bus/wait_set.hpp"
#include "telltale/client/fleet/subscriber.hpp"
#include "telltale/idl/codec/wire/ros2.hpp"

namespace telltale {

/// Carries what the daemon publishes to ROS 2.
///
/// Quality: once a second on rt/diagnostics (diagnostic_msgs/msg/DiagnosticArray, reliable), a
/// status for each boat; one that the daemon has said nothing of for ten seconds is STALE. Models:
/// model.json on rt/telltale/NAME/model (std_msgs/msg/String, reliable, transient local), where
/// NAME is RosNameOf() the vehicle id.
class Ros2Publisher {
 public:
  using Report = std::function<void(const std::string& what)>;

  /// `ros`: in the domain of the topics; `bus`: in that of the daemon; they may be one. Throws
  /// BusError.
  Ros2Publisher(const Participant& ros, const Participant& bus, Report report);

  /// Publishes what has come. To be called once a second, with UTC in seconds.
  void EachSecond(double now_s);

 private:
  using ModelWriter = RosWriter<std_msgs_msg_dds__String_>;
  struct Boat {
    Quality quality;
    double heard_s = 0.0;
  };

  void Publish(const PublishedModel& model);
  std::vector<Quality> Boats() const;

  const Participant& ros_;
  Report report_;
  double now_s_ = 0.0;
  std::map<std::string, Boat> boats_;
  std::map<std::string, ModelWriter> models_;  ///< by vehicle id
  RosWriter<diagnostic_msgs_msg_dds__DiagnosticArray_> diagnostics_;
  WaitSet wait_set_;
  ModelSubscription model_subscription_;
  TopicSubscription<telltale_wire_Quality, Quality> quality_subscription_;
};

}  // namespace telltale
