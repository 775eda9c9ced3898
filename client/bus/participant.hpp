#pragma once

#include <cstdint>

#include "telltale/client/bus/entity.hpp"

namespace telltale {

inline constexpr std::uint32_t kHighestDomain =
    101;  ///< the last whose ports are not ephemeral ones

/// This process's presence in a DDS domain. Transport and discovery follow CYCLONEDDS_URI.
/// Throws BusError when the domain cannot be joined.
class Participant {
 public:
  explicit Participant(std::uint32_t domain);

  dds_entity_t handle() const { return entity_.handle(); }

 private:
  Entity entity_;
};

}  // namespace telltale
