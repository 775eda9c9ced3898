#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "telltale/client/bus/participant.hpp"
#include "telltale/client/bus/writer.hpp"
#include "telltale/idl/codec/messages/telemetry.hpp"

namespace telltale {

/// One vehicle's telemetry going out. Each channel counts its samples from 1, so that receivers see
/// what they missed. Requires: a vehicle id of 1..64 letters, digits, '.', '_' or '-'.
class TelemetryPublisher {
 public:
  /// How it leaves. Settled: it sends what is left and leaves a moment later, since a receiver that
  /// hears of the leave-taking drops what has not reached it yet. At once: of a boat that runs on,
  /// whose last samples are no more than a gap.
  enum class Leave { kSettled, kAtOnce };

  TelemetryPublisher(const Participant& participant, std::string vehicle_id,
                     Leave leave = Leave::kSettled);
  TelemetryPublisher(const TelemetryPublisher&) = delete;
  TelemetryPublisher& operator=(const TelemetryPublisher&) = delete;

  ~TelemetryPublisher();

  /// False when within `timeout` nobody was there to receive all three channels. Where somebody is,
  /// it waits a moment more for them to learn of this side: what is sent before they do is lost,
  /// and nothing tells.
  bool WaitForReaders(std::chrono::nanoseconds timeout) const;

  void Publish(const GnssFix& fix);
  void Publish(const HeadingSample& heading);
  void Publish(const ThrusterSample& thrusters);

  /// Sends what BatchWrites() has held together.
  void Flush();

  std::uint64_t Published() const { return fixes_ + headings_ + thrusters_; }

 private:
  const Participant& participant_;
  std::string vehicle_id_;
  Leave leave_;
  Writer<telltale_wire_GnssFix> gnss_writer_;
  Writer<telltale_wire_Heading> heading_writer_;
  Writer<telltale_wire_Thrusters> thruster_writer_;
  std::uint64_t fixes_ = 0;
  std::uint64_t headings_ = 0;
  std::uint64_t thrusters_ = 0;
};

}  // namespace telltale
