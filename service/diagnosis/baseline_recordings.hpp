#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "telltale/core/data/samples.hpp"

namespace telltale {

/// The recording behind each vehicle's newest model, kept while the daemon runs: what the boat did
/// when the model was true of it. Safe to use from several threads.
class BaselineRecordings {
 public:
  void Keep(const std::string& vehicle_id, std::uint64_t revision, Recording recording);

  /// Nothing where that revision's recording is not at hand.
  std::optional<Recording> Behind(std::string_view vehicle_id, std::uint64_t revision) const;

 private:
  struct Kept {
    std::uint64_t revision = 0;
    Recording recording;
  };

  mutable std::mutex mutex_;
  std::map<std::string, Kept, std::less<>> kept_;
};

}  // namespace telltale
