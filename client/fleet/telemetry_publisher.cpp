#include "telltale/client/fleet/telemetry_publisher.hpp"

#include <thread>
#include <utility>

#include "telltale/client/fleet/vehicle_partitions.hpp"
#include "telltale/idl/codec/wire/telemetry.hpp"

namespace telltale {
namespace {

// Both sides of a match learn of its coming and going within milliseconds; a busy machine takes
// longer.
constexpr auto kSettling = std::chrono::milliseconds(200);

}  // namespace

TelemetryPublisher::TelemetryPublisher(const Participant& participant, std::string vehicle_id,
                                       Leave leave)
    : participant_(participant),
      vehicle_id_(std::move(vehicle_id)),
      leave_(leave),
      gnss_writer_(participant, InPartitionsOf(vehicle_id_, TelemetryQos())),
      heading_writer_(participant, InPartitionsOf(vehicle_id_, TelemetryQos())),
      thruster_writer_(participant, InPartitionsOf(vehicle_id_, TelemetryQos())) {}

TelemetryPublisher::~TelemetryPublisher() {
  if (leave_ == Leave::kAtOnce || Published() == 0) return;
  Flush();
  std::this_thread::sleep_for(kSettling);
}

bool TelemetryPublisher::WaitForReaders(std::chrono::nanoseconds timeout) const {
  if (!WaitForMatch(participant_, {gnss_writer_, heading_writer_, thruster_writer_}, timeout)) {
    return false;
  }
  std::this_thread::sleep_for(kSettling);
  return true;
}

void TelemetryPublisher::Publish(const GnssFix& fix) {
  gnss_writer_.Write(Encode(Telemetry<GnssFix>{vehicle_id_, ++fixes_, fix}));
}

void TelemetryPublisher::Publish(const HeadingSample& heading) {
  heading_writer_.Write(Encode(Telemetry<HeadingSample>{vehicle_id_, ++headings_, heading}));
}

void TelemetryPublisher::Publish(const ThrusterSample& thrusters) {
  thruster_writer_.Write(Encode(Telemetry<ThrusterSample>{vehicle_id_, ++thrusters_, thrusters}));
}

void TelemetryPublisher::Flush() {
  gnss_writer_.Flush();
  heading_writer_.Flush();
  thruster_writer_.Flush();
}

}  // namespace telltale
