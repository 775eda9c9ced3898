#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "telltale/core/data/samples.hpp"
#include "telltale/service/ingest/topic_connections.hpp"
#include "telltale/service/jobs/queue_activity.hpp"
#include "telltale/service/retention/retention.hpp"
#include "telltale/service/storage/write_durations.hpp"
#include "telltale/service/windows/window_archive.hpp"
#include "telltale/service/workers/heavy_activity.hpp"

namespace telltale {

/// What a store has written.
struct StoreActivity {
  std::string store;  ///< the name of its database without ".sqlite"
  WriteDurations::Sum written;
};

/// What the parts of the daemon are at, and what they have done since it started.
struct DaemonActivity {
  bool serves = false;    ///< answers requests and publishes
  bool is_ready = false;  ///< it serves, or stands by for a daemon that does
  std::size_t vehicles = 0;
  std::chrono::steady_clock::duration ingest_silence{0};  ///< since the ingest loop came round
  std::vector<QueueActivity> queues;
  std::vector<HeavyActivity> heavy_jobs;  ///< none where it has no workers
  std::vector<StoreActivity> stores;
  WindowActivity windows;
  std::size_t unwritten_requests = 0;
  RetentionActivity retention;
  std::array<std::uint64_t, kChannels.size()> received{};  ///< samples taken from the bus
  std::vector<TopicConnections> matches;
};

}  // namespace telltale
