#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "telltale/idl/codec/messages/model.hpp"

namespace telltale {

/// Which models of a fleet are no step back. Not thread safe.
class NewestModels {
 public:
  /// False where the model is older, by revision and by time, than one that was admitted for its
  /// vehicle. A lower revision that is newer comes from a daemon that has begun anew, and counts.
  bool Admit(const PublishedModel& model) {
    const Version version{model.revision, model.published_unix_s};
    const auto [known, is_first] = newest_.emplace(model.identification.vehicle_id, version);
    Version& newest = known->second;
    if (version.revision < newest.revision && version.unix_s < newest.unix_s) return false;
    newest = version;
    return true;
  }

 private:
  struct Version {
    std::uint64_t revision = 0;
    double unix_s = 0.0;
  };

  std::map<std::string, Version> newest_;  ///< by vehicle id
};

}  // namespace telltale
