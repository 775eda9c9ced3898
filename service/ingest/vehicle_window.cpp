#include "telltale/service/ingest/vehicle_window.hpp"

#include <algorithm>
#include <utility>

namespace telltale {

VehicleWindow::VehicleWindow(Vehicle vehicle, const WindowLimits& limits)
    : vehicle_(std::move(vehicle)), limits_(limits), window_(limits) {}

void VehicleWindow::Add(std::uint64_t sequence_number, const GnssFix& fix) {
  Add(Channel::kGnss, sequence_number, fix);
}

void VehicleWindow::Add(std::uint64_t sequence_number, const HeadingSample& heading) {
  Add(Channel::kHeading, sequence_number, heading);
}

void VehicleWindow::Add(std::uint64_t sequence_number, const ThrusterSample& thrusters) {
  Add(Channel::kThrusters, sequence_number, thrusters);
}

void VehicleWindow::Add(Channel channel, std::uint64_t sequence_number, const Sample& sample) {
  {
    const std::lock_guard lock(inbox_mutex_);
    inbox_.push_back(sample);
    gaps_[static_cast<std::size_t>(channel)].Note(
        sequence_number, std::visit([](const auto& s) { return s.time_s; }, sample));
    ++arrived_[static_cast<std::size_t>(channel)];
  }
  if (const std::unique_lock lock(window_mutex_, std::try_to_lock); lock) EmptyInbox();
}

Recording VehicleWindow::Snapshot() {
  const std::lock_guard lock(window_mutex_);
  EmptyInbox();
  return window_.Snapshot();
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
  state.newest_fix = newest_fix_;
  state.newest_heading = newest_heading_;
  const std::lock_guard inbox_lock(inbox_mutex_);
  state.arrived = arrived_;
  for (const SequenceGaps& gaps : gaps_) state.lost += gaps.lost();
  return state;
}

void VehicleWindow::NoteNewest(const Sample& sample) {
  if (const auto* fix = std::get_if<GnssFix>(&sample)) newest_fix_ = *fix;
  if (const auto* heading = std::get_if<HeadingSample>(&sample)) newest_heading_ = *heading;
}

void VehicleWindow::EmptyInbox() {
  {
    const std::lock_guard lock(inbox_mutex_);
    std::swap(inbox_, emptied_);
  }
  for (const Sample& sample : emptied_) {
    const bool kept = !std::visit([&](const auto& s) { return window_.Add(s); }, sample);
    if (!kept) continue;
    ++accepted_;
    NoteNewest(sample);
  }
  emptied_.clear();
}

}  // namespace telltale
