#pragma once

#include <string>

#include "telltale/client/bus/bus_error.hpp"
#include "telltale/client/bus/endpoint.hpp"
#include "telltale/client/bus/qos.hpp"
#include "telltale/idl/codec/wire/wire_sample.hpp"

namespace telltale {

/// Publishes one topic of ROS 2, whose name is chosen at run time.
template <class Wire>
class RosWriter : public Endpoint {
 public:
  /// `topic` as DDS has it, "rt/diagnostics". Throws BusError.
  RosWriter(const Participant& participant, const std::string& topic, const Qos& qos)
      : Endpoint(participant, Kind::kWriter, Descriptor<Wire>(), topic.c_str(), qos.get()),
        topic_(topic) {}

  /// False when a stalled reader left no room.
  bool Write(const WireSample<Wire>& sample) {
    const dds_return_t result = dds_write(handle(), &*sample);
    if (result == DDS_RETCODE_TIMEOUT) return false;
    Checked(result, "writing to " + topic_);
    return true;
  }

 private:
  std::string topic_;
};

}  // namespace telltale
