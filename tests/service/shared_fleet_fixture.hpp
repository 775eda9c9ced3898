#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "service/service_fixture.hpp"
#include "telltale/core/paper/yellowfish.hpp"
#include "telltale/idl/codec/vehicle_file.hpp"
#include "telltale/service/storage/stores.hpp"

namespace telltale {

/// Daemons that share a fleet in one database.
class SharedFleetTest : public ServiceTest {
 protected:
  static constexpr double kLeaseS = 4.0;

  /// Of boat-1, boat-2, ...
  explicit SharedFleetTest(int boats) : ServiceTest(Engine::kPostgres) {
    for (int number = 1; number <= boats; ++number) {
      Vehicle vehicle = YellowfishVehicle();
      vehicle.vehicle_id = "boat-" + std::to_string(number);
      folder_.Write("boats/" + vehicle.vehicle_id + ".textproto", PrintVehicle(vehicle));
      boats_.push_back(vehicle.vehicle_id);
    }
  }

  /// A configuration with a state directory of this name.
  std::filesystem::path ConfigOf(const std::string& name, const std::string& slices) const {
    return folder_.Write(
        name + ".textproto",
        "domain: " + std::to_string(domain_.id()) + "\nvehicle_folder: \"boats\"\n" +
            "state_directory: \"" + (folder_.Path() / name).string() + "\"\ndatabase: \"" +
            engine_.Address() +
            "\"\nidentification { bootstrap_replicates: 0 structure: \"static\" }\n" +
            "quality_period_s: 0.1\nwindow { save_period_s: 0.2 }\n" + slices);
  }

  /// A daemon that has a part of the fleet.
  std::unique_ptr<Process> StartNamed(const std::string& name) const {
    const std::string config =
        ConfigOf(name, "slices { lease_s: " + std::to_string(kLeaseS) + " }\n");
    return std::make_unique<Process>(std::vector<std::string>{TELLTALED, "--config", config});
  }

  /// How many leases begin before the one before has ended, or do not count up by one.
  int OverlappingLeases() const {
    int overlapping = 0;
    std::map<int, std::pair<std::int64_t, double>> newest;
    Storage()
        .Open(SlicesSchema())
        ->Query("SELECT * FROM leases ORDER BY slice, fence", {}, [&](const Row& row) {
          auto& [fence, until] = newest[static_cast<int>(row.Integer("slice"))];
          const bool follows =
              row.Integer("fence") == fence + 1 && row.Real("since_unix_s") >= until;
          overlapping += follows ? 0 : 1;
          fence = row.Integer("fence");
          until = row.Real("until_unix_s");
        });
    EXPECT_EQ(newest.size(), 64u);
    return overlapping;
  }

  std::vector<std::string> boats_;
};

}  // namespace telltale
