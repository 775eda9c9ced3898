#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <string>

#include "telltale/client/bus/endpoint.hpp"
#include "telltale/idl/codec/messages/quality.hpp"

namespace telltale {

/// The newest quality of every vehicle, from one daemon or from several that share a fleet. A
/// daemon ends each round of its reports with what names no vehicle; between two such ends of one
/// daemon every other has reported on all of its vehicles, since all report equally often.
class QualityRounds {
 public:
  void Take(const Quality& quality, WriterHandle daemon) {
    fleet_[quality.vehicle_id] = quality;
    if (quality.vehicle_id != kUnattributed || ended_.insert(daemon).second) return;
    ended_ = {daemon};
    ++complete_;
  }

  /// How often every vehicle has been reported on.
  std::size_t complete() const { return complete_; }
  const std::map<std::string, Quality>& fleet() const { return fleet_; }

 private:
  std::map<std::string, Quality> fleet_;
  std::set<WriterHandle> ended_;  ///< whose rounds have ended once since the fleet was complete
  std::size_t complete_ = 0;
};

}  // namespace telltale
