#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "telltale/core/data/samples.hpp"

namespace telltale {

/// The recording behind each vehicle's newest model, in memory while the daemon runs. A diagnosis
/// takes it as the baseline. Safe to use from several threads.
class BaselineRecordings {
 public:
  void Keep(const std::string& vehicle_id, std::uint64_t revision, Recording recording);

  /// The recording that made this revision; nothing where the daemon does not hold it.
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
