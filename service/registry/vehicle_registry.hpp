#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "telltale/client/bus/bus_log.hpp"
#include "telltale/core/vessel/vehicle.hpp"
#include "telltale/idl/codec/daemon_config.hpp"
#include "telltale/service/registry/vehicle_store.hpp"

namespace telltale {

/// What becomes of a boat that announces itself.
enum class Admission {
  kAdmitted,        ///< it joins the fleet
  kChanged,         ///< it was of the fleet, and has other particulars from now on
  kKnown,           ///< nothing changes
  kConfigured,      ///< the configuration says what it is, and wins
  kNotAdmitted,     ///< no pattern has its id
  kBeyondLimit,     ///< as many as are allowed have been admitted
  kTooManyChanges,  ///< it has joined or changed five times in ten minutes
};

/// As counts and logs call it.
std::string_view Name(Admission admission);

/// The boats of the whole fleet: those of the configuration, and those that have announced
/// themselves and that the rule admits. The latter are stored, so that they are of the fleet after
/// a restart before they are heard again. Each boat that was admitted since the start counts for
/// the limit, also once it is retired: what is kept of it stays in memory. Daemons that share a
/// fleet hear the same boats, and each stores those of its own slices. Not thread safe.
class VehicleRegistry {
 public:
  using Clock = std::chrono::steady_clock;

  /// Reads the boats that are stored. Throws DatabaseError.
  VehicleRegistry(const Storage& storage, std::vector<Vehicle> configured,
                  AnnouncedSettings announced);

  /// A configuration that is read anew. Boats that the rule no longer admits stay stored.
  void Configure(std::vector<Vehicle> configured, AnnouncedSettings announced);

  Admission Announce(const Vehicle& vehicle, Clock::time_point now);

  /// Forgets a boat that has announced itself. False where there is none.
  bool Retire(const std::string& vehicle_id);

  /// Stores what has changed. Throws DatabaseError; then it is still to be stored.
  void Store();
  bool HasUnstored() const;  ///< of the slices that this daemon holds

  /// Adds what other daemons have stored. Throws DatabaseError.
  void ReadStored();

  std::vector<Vehicle> Vehicles() const;
  bool Contains(const std::string& vehicle_id) const;

 private:
  bool IsConfigured(const std::string& vehicle_id) const;
  bool Admits(const std::string& vehicle_id) const;

  const Storage storage_;
  VehicleStore store_;
  std::map<std::string, Vehicle> configured_;
  AnnouncedSettings rule_;
  std::map<std::string, Vehicle> announced_;  ///< admitted once, by any rule
  std::set<std::string> unstored_;            ///< ids whose boats have come, changed or gone
  std::map<std::string, RateLimit> changes_;  ///< of each boat that was admitted since the start
};

}  // namespace telltale
