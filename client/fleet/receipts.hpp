#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "telltale/client/bus/participant.hpp"
#include "telltale/client/fleet/subscriber.hpp"
#include "telltale/idl/codec/messages/quality.hpp"

namespace telltale {

/// How many samples of one vehicle the daemon has taken in since this began, by the counts on the
/// quality topic. Telemetry is best effort and has no acknowledgement of its own; a sender that
/// never has more samples under way than a reader holds loses none to a busy receiver.
class Receipts {
 public:
  Receipts(const Participant& participant, std::string vehicle_id);

  /// Waits for the first report on this vehicle, from which counting starts. False when nobody
  /// publishes quality, whole rounds of reports lack the vehicle, or `timeout` passes.
  bool Begin(std::chrono::nanoseconds timeout);

  /// Waits until at least `count` samples are accounted for: kept, rejected, shed or known to be
  /// lost.
  /// False when the count has not moved for `patience`.
  bool WaitFor(std::uint64_t count, std::chrono::nanoseconds patience);

  /// Takes samples that nobody will account for any more as lost.
  void WriteOff(std::uint64_t count) { written_off_ += count; }

  std::uint64_t Accounted() const { return total_ - begun_at_.value_or(total_) + written_off_; }

  /// Samples that were sent and did not arrive.
  std::uint64_t Lost() const { return lost_ - lost_before_ + written_off_; }

  /// Samples that arrived and that the daemon did not take in, since too many came.
  std::uint64_t Shed() const { return shed_ - shed_before_; }

 private:
  void Take(const Quality& quality);

  std::string vehicle_id_;
  std::optional<std::uint64_t> begun_at_;
  std::uint64_t total_ = 0;
  std::uint64_t lost_ = 0;
  std::uint64_t lost_before_ = 0;
  std::uint64_t shed_ = 0;
  std::uint64_t shed_before_ = 0;
  std::uint64_t written_off_ = 0;
  int rounds_without_ = 0;  ///< rounds of reports without this vehicle
  QualitySubscriber qualities_;
};

}  // namespace telltale
