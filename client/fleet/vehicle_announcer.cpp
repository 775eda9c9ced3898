#include "telltale/client/fleet/vehicle_announcer.hpp"

#include "telltale/client/fleet/vehicle_partitions.hpp"
#include "telltale/core/base/contract.hpp"
#include "telltale/idl/codec/wire/vehicle_announcement.hpp"

namespace telltale {

VehicleAnnouncer::VehicleAnnouncer(const Participant& participant, const std::string& vehicle_id)
    : participant_(&participant),
      vehicle_id_(vehicle_id),
      writer_(participant, InPartitionsOf(vehicle_id, VehicleQos())) {}

void VehicleAnnouncer::Announce(const Vehicle& vehicle) {
  Require(vehicle.vehicle_id == vehicle_id_, "the vehicle of the announcer");
  writer_.Write(Encode(vehicle));
  writer_.Flush();
}

bool VehicleAnnouncer::WaitForReaders(std::chrono::nanoseconds timeout) const {
  return WaitForMatch(*participant_, {writer_}, timeout);
}

void VehicleAnnouncer::Retire() {
  writer_.Dispose(EncodeRetired(vehicle_id_));
  writer_.Flush();
}

}  // namespace telltale
