#pragma once

#include <cstdint>
#include <string>

namespace telltale {

inline constexpr std::uint32_t kHighestStrength = 1000;   ///< that can be configured
inline constexpr std::uint32_t kHighestTerm = 2'000'000;  ///< OwnershipStrengthOn() has 31 bits

/// What a daemon says of itself to those that stand in for it. Each daemon that takes over from
/// another does so for a later term.
struct DaemonStatus {
  std::string daemon_id;                 ///< another at each start
  bool serves = false;                   ///< it answers requests and publishes
  std::uint32_t term = 0;                ///< of the daemon that serves; 0: it knows of none
  std::uint32_t ownership_strength = 1;  ///< configured, [1, kHighestStrength]
};

/// The ownership strength that the daemon's writers have on the bus. A later term exceeds every
/// earlier one, so that readers pass over what a daemon writes that has been replaced.
inline std::int32_t OwnershipStrengthOn(const DaemonStatus& status) {
  return static_cast<std::int32_t>(status.term * (kHighestStrength + 1) +
                                   status.ownership_strength);
}

}  // namespace telltale
