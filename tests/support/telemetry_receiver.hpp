#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "telltale/client/bus/participant.hpp"
#include "telltale/client/bus/reader.hpp"
#include "telltale/client/bus/wait_set.hpp"
#include "telltale/idl/codec/wire/telemetry.hpp"

namespace telltale {

/// What came over DDS of one vehicle.
struct ReceivedTelemetry {
  std::vector<GnssFix> gnss;
  std::vector<HeadingSample> heading;
  std::vector<ThrusterSample> thrusters;

  bool HasAll(std::size_t of_each = 1) const {
    return gnss.size() >= of_each && heading.size() >= of_each && thrusters.size() >= of_each;
  }
};

/// Keeps the telemetry of all vehicles of a domain.
class TelemetryReceiver {
 public:
  explicit TelemetryReceiver(std::uint32_t domain) : participant_(domain) {
    Follow(gnss_, &ReceivedTelemetry::gnss);
    Follow(heading_, &ReceivedTelemetry::heading);
    Follow(thrusters_, &ReceivedTelemetry::thrusters);
  }

  std::map<std::string, ReceivedTelemetry>& Of() { return received_; }

  /// Receives until `condition` holds; false when a minute passes without.
  template <class Condition>
  bool ReceiveUntil(Condition condition) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (!condition()) {
      if (std::chrono::steady_clock::now() > deadline) return false;
      wait_set_.Wait(std::chrono::milliseconds(20));
    }
    return true;
  }

 private:
  template <class Wire, class Sample>
  void Follow(Reader<Wire>& reader, std::vector<Sample> ReceivedTelemetry::*channel) {
    wait_set_.Attach(reader, [this, &reader, channel] {
      reader.Take([&](const Wire& wire) {
        const auto telemetry = Decode(wire);
        ASSERT_TRUE(telemetry);
        (received_[std::string(telemetry->vehicle_id)].*channel).push_back(telemetry->sample);
      });
    });
  }

  Participant participant_;
  WaitSet wait_set_{participant_};
  Reader<telltale_wire_GnssFix> gnss_{participant_};
  Reader<telltale_wire_Heading> heading_{participant_};
  Reader<telltale_wire_Thrusters> thrusters_{participant_};
  std::map<std::string, ReceivedTelemetry> received_;
};

}  // namespace telltale
