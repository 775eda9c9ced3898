#include "telltale/service/ingest/vehicle_window.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace telltale {

VehicleWindow::VehicleWindow(Vehicle vehicle, const WindowLimits& limits)
    : vehicle_(std::move(vehicle)),
      limits_(limits),
      memory_bytes_(limits.memory_bytes),
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
    NoteArrival(channel, sequence_number, sample.time_s, at);
    if (!window_lock || unloaded_) {
      Wait({sample, at}, channel);
      if (unloaded_) store_.wanted();
      return;
    }
    std::swap(inbox_, emptied_);
  }
  InsertEmptied();
  Insert(sample, at);
}

/// The caller holds inbox_mutex_.
void VehicleWindow::Wait(const Arrival& arrival, Channel channel) {
  if (inbox_.size() < memory_bytes_ / sizeof(Arrival)) return inbox_.push_back(arrival);
  ++shed_[static_cast<std::size_t>(channel)];
}

void VehicleWindow::Shed(Channel channel, std::uint64_t sequence_number, double time_s) {
  const std::lock_guard lock(inbox_mutex_);
  NoteArrival(channel, sequence_number, time_s, Clock::now());
  ++shed_[static_cast<std::size_t>(channel)];
}

/// The caller holds inbox_mutex_.
void VehicleWindow::NoteArrival(Channel channel, std::uint64_t sequence_number, double time_s,
                                Clock::time_point at) {
  last_used_ = at;
  gaps_[static_cast<std::size_t>(channel)].Note(sequence_number, time_s);
  ++arrived_[static_cast<std::size_t>(channel)];
}

void VehicleWindow::LimitMemory(std::size_t memory_bytes) {
  const std::lock_guard window_lock(window_mutex_);
  window_.LimitMemory(memory_bytes);
  if (unsaved_) unsaved_->LimitMemory(memory_bytes);
  const std::lock_guard inbox_lock(inbox_mutex_);
  memory_bytes_ = memory_bytes;
}

bool VehicleWindow::UnloadIfUnused(std::chrono::duration<double> unused, Clock::time_point now) {
  const std::scoped_lock lock(window_mutex_, inbox_mutex_);
  const bool all_is_saved = inbox_.empty() && unsaved_ && unsaved_->size() == 0;
  if (unloaded_ || !all_is_saved || window_.Empty() || now - last_used_ < unused) return false;
  unloaded_span_ = {window_.StartTime(), window_.EndTime()};
  rejected_before_.Add(window_.Rejected());
  window_ = Window(limits_);
  window_.LimitMemory(memory_bytes_);
  inbox_.shrink_to_fit();
  emptied_.shrink_to_fit();
  unloaded_ = true;
  return true;
}

void VehicleWindow::Load() {
  const std::lock_guard loading(loading_mutex_);
  {
    const std::lock_guard lock(inbox_mutex_);
    last_used_ = Clock::now();
    if (!unloaded_) return;
  }
  std::vector<Recording> saved;  // read without the lock, which State() needs meanwhile
  store_.load(vehicle_.vehicle_id, [&](const Recording& samples) { saved.push_back(samples); });
  const std::lock_guard lock(window_mutex_);
  {
    const std::lock_guard inbox_lock(inbox_mutex_);
    if (!std::exchange(unloaded_, false)) return;  // another window has taken over meanwhile
  }
  for (const Recording& samples : saved) Refill(samples);
  EmptyInbox();
}

bool VehicleWindow::WaitsForLoad() {
  const std::lock_guard lock(inbox_mutex_);
  return unloaded_ && !inbox_.empty();
}

SavingState VehicleWindow::Saving() {
  const std::lock_guard lock(window_mutex_);
  if (!unsaved_) return {};
  return {unsaved_->size(), unsaved_->dropped(), unloaded_};
}

/// The caller holds window_mutex_.
std::pair<double, double> VehicleWindow::Span() const {
  return unloaded_ ? unloaded_span_ : std::pair(window_.StartTime(), window_.EndTime());
}

Recording VehicleWindow::Snapshot() {
  Load();
  const std::lock_guard lock(window_mutex_);
  EmptyInbox();
  return window_.Snapshot();
}

Recording VehicleWindow::Snapshot(double duration_s) {
  Load();
  const std::lock_guard lock(window_mutex_);
  EmptyInbox();
  return window_.Snapshot(duration_s);
}

WindowState VehicleWindow::State() {
  const std::lock_guard window_lock(window_mutex_);
  EmptyInbox();
  WindowState state;
  std::tie(state.start_s, state.end_s) = Span();
  state.fill = std::clamp((state.end_s - state.start_s) / limits_.duration_s, 0.0, 1.0);
  state.accepted = accepted_;
  state.rejected = rejected_before_;
  state.rejected.Add(window_.Rejected());
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
    if (unloaded_) return;
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
  if (unsaved_) unsaved_->Add(sample);
}

void VehicleWindow::BeginSaving(Store store) {
  const std::scoped_lock lock(window_mutex_, inbox_mutex_);
  unsaved_.emplace(memory_bytes_);
  store_ = std::move(store);
}

Recording VehicleWindow::TakeUnsaved() {
  const std::lock_guard lock(window_mutex_);
  EmptyInbox();
  if (!unsaved_) return {};
  return unsaved_->Take();
}

void VehicleWindow::TakeOver(VehicleWindow& former) {
  const std::scoped_lock windows(window_mutex_, former.window_mutex_);
  former.EmptyInbox();
  std::swap(window_, former.window_);
  unloaded_span_ = former.unloaded_span_;
  rejected_before_ = former.rejected_before_;
  accepted_ = former.accepted_;
  clock_jumps_ = former.clock_jumps_;
  newest_fix_ = former.newest_fix_;
  newest_heading_ = former.newest_heading_;
  unsaved_ = std::exchange(former.unsaved_, std::nullopt);
  const std::scoped_lock inboxes(inbox_mutex_, former.inbox_mutex_);
  store_ = former.store_;
  unloaded_ = std::exchange(former.unloaded_, false);
  if (unloaded_) inbox_ = std::exchange(former.inbox_, {});
  last_used_ = former.last_used_;
  gaps_ = former.gaps_;
  arrived_ = former.arrived_;
  shed_ = former.shed_;
}

void VehicleWindow::Restore(const Recording& samples) {
  const std::lock_guard lock(window_mutex_);
  Refill(samples);
}

/// The caller holds window_mutex_.
void VehicleWindow::Refill(const Recording& samples) {
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
