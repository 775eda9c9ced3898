#include "telltale/service/ingest/vehicle_window.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace telltale {
namespace {

/// Those of the channel that the type is of.
template <class One>
std::vector<One>& SamplesOf(Recording& recording) {
  return std::get<std::vector<One>&>(
      std::tie(recording.gnss, recording.heading, recording.thrusters));
}

}  // namespace

VehicleWindow::VehicleWindow(Vehicle vehicle, const WindowLimits& limits)
    : vehicle_(std::move(vehicle)),
      limits_(limits),
      most_waiting_(limits.memory_bytes / sizeof(Arrival)),
      window_(limits),
      clock_jumps_(limits.clock_jump_s) {}

void VehicleWindow::Add(std::uint64_t sequence_number, const GnssFix& fix, Clock::time_point at) {
  Add(Channel::kGnss, sequence_number, fix, at);
}

void VehicleWindow::Add(std::uint64_t sequence_number, const HeadingSample& heading,
                        Clock::time_point at) {
  Add(Channel::kHeading, sequence_number, heading, at);
}

void VehicleWindow::Add(std::uint64_t sequence_number, const ThrusterSample& thrusters,
                        Clock::time_point at) {
  Add(Channel::kThrusters, sequence_number, thrusters, at);
}

template <class One>
void VehicleWindow::Add(Channel channel, std::uint64_t sequence_number, const One& sample,
                        Clock::time_point at) {
  const std::unique_lock window_lock(window_mutex_, std::try_to_lock);
  {
    const std::lock_guard lock(inbox_mutex_);
    NoteArrival(channel, sequence_number, sample.time_s);
    if (!window_lock && inbox_.size() >= most_waiting_) {
      ++shed_[static_cast<std::size_t>(channel)];
      return;
    }
    if (!window_lock) return inbox_.push_back({sample, at});
    std::swap(inbox_, emptied_);
  }
  InsertEmptied();
  Insert(sample, at);
}

void VehicleWindow::Shed(Channel channel, std::uint64_t sequence_number, double time_s) {
  const std::lock_guard lock(inbox_mutex_);
  NoteArrival(channel, sequence_number, time_s);
  ++shed_[static_cast<std::size_t>(channel)];
}

/// The caller holds inbox_mutex_.
void VehicleWindow::NoteArrival(Channel channel, std::uint64_t sequence_number, double time_s) {
  gaps_[static_cast<std::size_t>(channel)].Note(sequence_number, time_s);
  ++arrived_[static_cast<std::size_t>(channel)];
}

void VehicleWindow::LimitMemory(std::size_t memory_bytes) {
  const std::lock_guard window_lock(window_mutex_);
  window_.LimitMemory(memory_bytes);
  const std::lock_guard inbox_lock(inbox_mutex_);
  most_waiting_ = memory_bytes / sizeof(Arrival);
}

Recording VehicleWindow::Snapshot() {
  const std::lock_guard lock(window_mutex_);
  EmptyInbox();
  return window_.Snapshot();
}

Recording VehicleWindow::Snapshot(double duration_s) {
  const std::lock_guard lock(window_mutex_);
  EmptyInbox();
  return window_.Snapshot(duration_s);
}

WindowState VehicleWindow::State() {
  const std::lock_guard window_lock(window_mutex_);
  EmptyInbox();
  WindowState state;
  state.start_s = window_.StartTime();
  state.end_s = window_.EndTime();
  state.fill = std::clamp((state.end_s - state.start_s) / limits_.duration_s, 0.0, 1.0);
  state.accepted = accepted_;
  state.rejected = window_.Rejected();
  state.bytes = window_.StoredBytes();
  state.clock_jumps = clock_jumps_.count();
  state.newest_fix = newest_fix_;
  state.newest_heading = newest_heading_;
  const std::lock_guard inbox_lock(inbox_mutex_);
  state.arrived = arrived_;
  state.shed = shed_;
  for (const SequenceGaps& gaps : gaps_) state.lost += gaps.lost();
  return state;
}

void VehicleWindow::EmptyInbox() {
  {
    const std::lock_guard lock(inbox_mutex_);
    std::swap(inbox_, emptied_);
  }
  InsertEmptied();
}

void VehicleWindow::InsertEmptied() {
  for (const auto& [sample, at] : emptied_) {
    std::visit([this, at = at](const auto& one) { Insert(one, at); }, sample);
  }
  emptied_.clear();
}

template <class One>
void VehicleWindow::Insert(const One& sample, Clock::time_point at) {
  const double former_end_s = window_.EndTime();
  if (window_.Add(sample)) return;
  clock_jumps_.Note(window_.EndTime() - former_end_s, at);
  ++accepted_;
  NoteNewest(sample);
  if (unsaved_) SamplesOf<One>(*unsaved_).push_back(sample);
}

void VehicleWindow::BeginSaving() {
  const std::lock_guard lock(window_mutex_);
  unsaved_.emplace();
}

Recording VehicleWindow::TakeUnsaved() {
  const std::lock_guard lock(window_mutex_);
  EmptyInbox();
  if (!unsaved_) return {};
  return std::exchange(*unsaved_, {});
}

void VehicleWindow::TakeOver(VehicleWindow& former) {
  const std::scoped_lock windows(window_mutex_, former.window_mutex_);
  former.EmptyInbox();
  std::swap(window_, former.window_);
  accepted_ = former.accepted_;
  clock_jumps_ = former.clock_jumps_;
  newest_fix_ = former.newest_fix_;
  newest_heading_ = former.newest_heading_;
  unsaved_ = std::exchange(former.unsaved_, std::nullopt);
  const std::scoped_lock inboxes(inbox_mutex_, former.inbox_mutex_);
  gaps_ = former.gaps_;
  arrived_ = former.arrived_;
  shed_ = former.shed_;
}

void VehicleWindow::Restore(const Recording& samples) {
  const std::lock_guard lock(window_mutex_);
  // In the order of time, as they arrived: whether a position is stuck depends on the commands.
  auto fix = samples.gnss.begin();
  auto heading = samples.heading.begin();
  for (const ThrusterSample& command : samples.thrusters) {
    for (; fix != samples.gnss.end() && fix->time_s <= command.time_s; ++fix) window_.Add(*fix);
    for (; heading != samples.heading.end() && heading->time_s <= command.time_s; ++heading) {
      window_.Add(*heading);
    }
    window_.Add(command);
  }
  for (; fix != samples.gnss.end(); ++fix) window_.Add(*fix);
  for (; heading != samples.heading.end(); ++heading) window_.Add(*heading);
  if (!samples.gnss.empty()) newest_fix_ = samples.gnss.back();
  if (!samples.heading.empty()) newest_heading_ = samples.heading.back();
}

}  // namespace telltale
