#pragma once

#include <array>
#include <cstdint>
#include <mutex>
#include <optional>
#include <variant>
#include <vector>

#include "telltale/core/data/samples.hpp"
#include "telltale/core/data/window.hpp"
#include "telltale/core/vessel/vehicle.hpp"
#include "telltale/service/ingest/clock_jumps.hpp"
#include "telltale/service/ingest/sequence_gaps.hpp"

namespace telltale {

/// The contents of a vehicle's window, and the counts of the samples that have arrived for it.
struct WindowState {
  double start_s = 0.0;  ///< oldest and newest sample, by the vehicle's clock
  double end_s = 0.0;
  double fill = 0.0;                                      ///< share of the configured span, [0, 1]
  std::array<std::uint64_t, kChannels.size()> arrived{};  ///< gnss, heading, thrusters
  std::uint64_t accepted = 0;
  std::uint64_t lost = 0;
  std::array<std::uint64_t, kChannels.size()> shed{};  ///< of those that arrived
  RejectCounts rejected;
  std::size_t bytes = 0;              ///< memory of the samples held
  std::uint64_t clock_jumps = 0;      ///< of the vehicle's clock
  std::optional<GnssFix> newest_fix;  ///< of those kept
  std::optional<HeadingSample> newest_heading;
};

/// The sliding window of one vehicle, for one thread that fills it and several that read it.
/// Filling does not wait for a reader: samples that arrive during a copy wait in an inbox.
class VehicleWindow {
 public:
  using Clock = ClockJumps::Clock;

  VehicleWindow(Vehicle vehicle, const WindowLimits& limits);

  const Vehicle& vehicle() const { return vehicle_; }

  /// A sample that has arrived at `at`.
  void Add(std::uint64_t sequence_number, const GnssFix& fix, Clock::time_point at = Clock::now());
  void Add(std::uint64_t sequence_number, const HeadingSample& heading,
           Clock::time_point at = Clock::now());
  void Add(std::uint64_t sequence_number, const ThrusterSample& thrusters,
           Clock::time_point at = Clock::now());

  /// Counts a sample that has arrived and is not taken in.
  void Shed(Channel channel, std::uint64_t sequence_number, double time_s);

  /// As Window::LimitMemory(). As many bytes of samples may wait while the window is read; it sheds
  /// those that come beyond.
  void LimitMemory(std::size_t memory_bytes);

  /// The samples and counts of the same vehicle's former window, which is empty afterwards.
  void TakeOver(VehicleWindow& former);

  /// Samples of an earlier run, which count neither as arrived nor as accepted.
  void Restore(const Recording& samples);

  /// From now on the samples that are kept are noted for TakeUnsaved() too.
  void BeginSaving();

  /// The samples kept since the last call.
  Recording TakeUnsaved();

  Recording Snapshot();
  /// As that of the window.
  Recording Snapshot(double duration_s);
  WindowState State();

 private:
  using Sample = std::variant<GnssFix, HeadingSample, ThrusterSample>;

  struct Arrival {
    Sample sample;
    Clock::time_point at;
  };

  template <class One>
  void Add(Channel channel, std::uint64_t sequence_number, const One& sample, Clock::time_point at);
  template <class One>
  void Insert(const One& sample, Clock::time_point at);
  void NoteArrival(Channel channel, std::uint64_t sequence_number, double time_s);
  void EmptyInbox();  ///< into the window; the caller holds window_mutex_
  void InsertEmptied();
  void NoteNewest(const GnssFix& fix) { newest_fix_ = fix; }
  void NoteNewest(const HeadingSample& heading) { newest_heading_ = heading; }
  void NoteNewest(const ThrusterSample&) {}

  const Vehicle vehicle_;
  const WindowLimits limits_;

  std::mutex inbox_mutex_;
  std::vector<Arrival> inbox_;
  std::array<SequenceGaps, kChannels.size()> gaps_;
  std::array<std::uint64_t, kChannels.size()> arrived_{};
  std::array<std::uint64_t, kChannels.size()> shed_{};
  std::size_t most_waiting_;  ///< samples in the inbox

  std::mutex window_mutex_;
  std::vector<Arrival> emptied_;
  Window window_;
  std::uint64_t accepted_ = 0;
  ClockJumps clock_jumps_;
  std::optional<GnssFix> newest_fix_;
  std::optional<HeadingSample> newest_heading_;
  std::optional<Recording> unsaved_;
};

}  // namespace telltale
