#pragma once

#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "telltale/client/python/arguments.hpp"
#include "telltale/client/workbench/recorded_log.hpp"
#include "telltale/client/workbench/recorded_vehicle.hpp"

namespace telltale::python {

/// A log as the package has loaded it, with the vehicle that its user stated.
struct StatedLog {
  RecordedLog log;
  RawChannels recorded;  ///< before admission; checks need these, for whatever vehicle
  std::optional<Vehicle> stated;
  std::vector<std::string> notes;

  /// As stated, or as the log describes it.
  std::optional<Vehicle> KnownVehicle() const;
};

using Recordings = std::vector<std::shared_ptr<StatedLog>>;

/// One recording, or several of one boat.
using OneOrMore = std::variant<std::shared_ptr<StatedLog>, Recordings>;

/// Throws: UsageError where there is none, or one is None.
Recordings ListOf(const OneOrMore& recordings);

/// Throws: UsageError naming the argument, where one is None.
void RequireEach(const char* argument, const Recordings& recordings);

/// The recordings joined (Join), with `vehicle`, or else what they state themselves. Throws:
/// UsageError where they state different vehicles, and as Join.
RecordedVehicle Joined(const Recordings& recordings, const std::optional<VehicleOrFile>& vehicle,
                       InputFaults faults);

}  // namespace telltale::python
