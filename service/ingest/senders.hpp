#pragma once

#include <algorithm>
#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "telltale/client/bus/endpoint.hpp"

namespace telltale {

/// Whose telemetry a writer may send: where partitions are required, that of the vehicles in whose
/// partitions it is. DDS Security lets a boat have no partition of another. Not thread safe.
class Senders {
 public:
  explicit Senders(bool require_partition) : require_partition_(require_partition) {}

  /// `partitions_of(writer)` is asked once for each writer.
  template <class PartitionsOf>
  bool MaySend(WriterHandle writer, std::string_view vehicle_id, PartitionsOf partitions_of) {
    if (!require_partition_) return true;
    if (partitions_.size() >= kMostWriters) partitions_.clear();
    const auto [known, is_new] = partitions_.try_emplace(writer);
    if (is_new) known->second = partitions_of(writer);
    return std::ranges::find(known->second, vehicle_id) != known->second.end();
  }

 private:
  static constexpr std::size_t kMostWriters = 20000;  // those that are gone stay until then

  const bool require_partition_;
  std::map<WriterHandle, std::vector<std::string>> partitions_;
};

}  // namespace telltale
