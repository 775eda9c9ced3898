#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "telltale/client/bus/endpoint.hpp"
#include "telltale/service/jobs/urgency.hpp"

namespace telltale {

/// The client of what this daemon asks itself.
inline constexpr WriterHandle kNoClient = 0;

/// The stage of a request that no worker has begun.
inline constexpr std::string_view kQueuedStage = "queued";

/// How long a client is waited for that the bus has lost: one that is only cut off asks again, by
/// the writer that it has then, within seconds.
inline constexpr std::chrono::seconds kClientPatience{20};

/// Somebody who waits for the reply to a job.
template <class Reply>
struct Asker {
  using Clock = std::chrono::steady_clock;

  std::string correlation_id;
  std::optional<Clock::time_point> deadline;    ///< nobody waits after it
  std::function<void(const Reply&)> answer;     ///< unset: the reply goes out on the bus
  WriterHandle client = kNoClient;              ///< whose writer the request came from
  std::optional<Clock::time_point> gone_since;  ///< when the bus has lost the client
  /// Becomes true once the request is on disk. Unset: it is not kept there.
  std::shared_ptr<std::atomic<bool>> kept;

  /// Whether the asker may hear that the request is known.
  bool MayHear() const { return !answer && (!kept || *kept); }
  bool GivesUpBy(Clock::time_point now) const { return deadline && *deadline <= now; }
  bool IsGoneBy(Clock::time_point now) const {
    return gone_since && *gone_since + kClientPatience <= now;
  }
  /// When it gives up or counts as gone; nothing while it does not.
  std::optional<Clock::time_point> WaitsUntil() const {
    if (!gone_since) return deadline;
    const auto gone = *gone_since + kClientPatience;
    return deadline ? std::min(*deadline, gone) : gone;
  }
};

/// A piece of work, and all who have asked for it. The owner serialises access.
template <class Request, class Reply>
struct Job {
  using Clock = std::chrono::steady_clock;

  Request request;  ///< the first asker's
  std::vector<Asker<Reply>> askers;
  Urgency urgency = Urgency::kInteractive;
  std::uint64_t number = 0;                  ///< counts up by one per job
  std::optional<Clock::time_point> started;  ///< unset: it waits
  Clock::time_point advanced;                ///< its latest report of progress

  bool Waits() const { return !started; }

  /// Takes away the askers for whom `leaves` is true, and returns them.
  template <class Leaves>
  std::vector<Asker<Reply>> TakeAskers(Leaves leaves) {
    const auto first = std::stable_partition(
        askers.begin(), askers.end(), [&](const Asker<Reply>& asker) { return !leaves(asker); });
    std::vector<Asker<Reply>> taken(std::make_move_iterator(first),
                                    std::make_move_iterator(askers.end()));
    askers.erase(first, askers.end());
    return taken;
  }
};

}  // namespace telltale
