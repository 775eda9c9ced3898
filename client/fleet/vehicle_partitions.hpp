#pragma once

#include <string>
#include <utility>

#include "telltale/client/bus/qos.hpp"

namespace telltale {

/// The contract of a writer for one vehicle: in the partition of its id, by which DDS Security
/// holds a boat to what is its own, and in that of all, so that every daemon hears it.
inline Qos InPartitionsOf(const std::string& vehicle_id, Qos qos) {
  return InPartitions(std::move(qos), {"", vehicle_id});
}

}  // namespace telltale
