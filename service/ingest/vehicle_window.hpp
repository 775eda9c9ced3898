#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "telltale/core/data/samples.hpp"
#include "telltale/core/data/window.hpp"
#include "telltale/core/vessel/vehicle.hpp"
#include "telltale/service/ingest/clock_jumps.hpp"
#include "telltale/service/ingest/sequence_gaps.hpp"
#include "telltale/service/ingest/unsaved_samples.hpp"

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

/// How the samples of a window stand to the store.
struct SavingState {
  std::size_t unsaved = 0;    ///< samples that wait to be saved
  std::uint64_t dropped = 0;  ///< that went before they were
  bool unloaded = false;      ///< the store alone has the samples
};

/// The sliding window of one vehicle, for one thread that fills it and several that read it.
/// Filling does not wait for a reader: samples that arrive during a copy wait in an inbox.
///
/// A window that nobody uses may be unloaded: a store has its samples then, and State() tells what
/// it would with them. Who asks for the samples brings them back. Those that arrive meanwhile wait
/// in the inbox.
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

  /// As Window::LimitMemory(). As many bytes of samples may wait while the window is read or
  /// unloaded, and it sheds those that come beyond; as many may wait to be saved.
  void LimitMemory(std::size_t memory_bytes);

  /// The samples and counts of the same vehicle's former window, which is empty afterwards.
  void TakeOver(VehicleWindow& former);

  /// Samples of an earlier run, which count neither as arrived nor as accepted.
  void Restore(const Recording& samples);

  /// Where the samples of an unloaded window are.
  struct Store {
    /// Hands over the samples that are saved, oldest first. May throw.
    std::function<void(const std::string& vehicle_id,
                       const std::function<void(const Recording&)>& take)>
        load;
    /// A sample waits for them. Must return at once.
    std::function<void()> wanted;
  };

  /// From now on the samples that are kept are noted for TakeUnsaved() too.
  void BeginSaving(Store store);

  /// The samples kept since the last call.
  Recording TakeUnsaved();

  /// Leaves the samples to the store where no sample has arrived, and nobody has asked for any, in
  /// the time `unused` before `now`. False where the window is in use, is empty, or holds samples
  /// that TakeUnsaved() has not given. Assumes that the store has all that it gave.
  bool UnloadIfUnused(std::chrono::duration<double> unused, Clock::time_point now);

  /// Brings the samples back, where the window is unloaded. Throws as Store::load, and then stays
  /// unloaded; so do those that follow.
  void Load();

  Recording Snapshot();
  /// As that of the window.
  Recording Snapshot(double duration_s);
  WindowState State();

  /// Whether samples have arrived for an unloaded window.
  bool WaitsForLoad();
  SavingState Saving();

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
  void NoteArrival(Channel channel, std::uint64_t sequence_number, double time_s,
                   Clock::time_point at);
  void Wait(const Arrival& arrival, Channel channel);
  void EmptyInbox();  ///< into the window, unless it is unloaded; the caller holds window_mutex_
  void InsertEmptied();
  void Refill(const Recording& samples);
  std::pair<double, double> Span() const;
  void NoteNewest(const GnssFix& fix) { newest_fix_ = fix; }
  void NoteNewest(const HeadingSample& heading) { newest_heading_ = heading; }
  void NoteNewest(const ThrusterSample&) {}

  const Vehicle vehicle_;
  const WindowLimits limits_;

  std::mutex loading_mutex_;  // before the others

  std::mutex inbox_mutex_;
  std::vector<Arrival> inbox_;
  std::array<SequenceGaps, kChannels.size()> gaps_;
  std::array<std::uint64_t, kChannels.size()> arrived_{};
  std::array<std::uint64_t, kChannels.size()> shed_{};
  std::size_t memory_bytes_;  ///< of samples in the inbox, and of those that wait to be saved
  Clock::time_point last_used_ = Clock::now();
  bool unloaded_ = false;  ///< who writes it holds window_mutex_ too

  std::mutex window_mutex_;  // before inbox_mutex_
  std::vector<Arrival> emptied_;
  Window window_;
  std::pair<double, double> unloaded_span_;  ///< times of its oldest and newest sample
  RejectCounts rejected_before_;             ///< before it was last unloaded
  std::uint64_t accepted_ = 0;
  ClockJumps clock_jumps_;
  std::optional<GnssFix> newest_fix_;
  std::optional<HeadingSample> newest_heading_;
  std::optional<UnsavedSamples> unsaved_;
  Store store_;
};

}  // namespace telltale
