#pragma once

#include <chrono>
#include <string>

#include "telltale/client/bus/participant.hpp"
#include "telltale/client/bus/writer.hpp"
#include "telltale/core/vessel/vehicle.hpp"

namespace telltale {

/// Lets one boat announce itself: daemons that are there, and those that come while this lives,
/// hear which particulars it has. A boat whose announcer ends stays announced until it is retired.
/// Requires: a vehicle id of 1..64 letters, digits, '.', '_' or '-'.
class VehicleAnnouncer {
 public:
  VehicleAnnouncer(const Participant& participant, const std::string& vehicle_id);

  /// Says what the boat is; again with other particulars where they have changed.
  /// Requires: the id of this boat.
  void Announce(const Vehicle& vehicle);

  /// Waits for a daemon that hears announcements; false where none is there within `timeout`.
  bool WaitForReaders(std::chrono::nanoseconds timeout) const;

  /// Says to the daemons that are there that the boat is no more.
  void Retire();

 private:
  const Participant* participant_;
  std::string vehicle_id_;
  Writer<telltale_wire_VehicleAnnouncement> writer_;
};

}  // namespace telltale
