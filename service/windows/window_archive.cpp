#include "telltale/service/windows/window_archive.hpp"

#include <chrono>
#include <exception>
#include <map>
#include <utility>
#include <vector>

#include <spdlog/spdlog.h>

#include "telltale/service/freed_memory.hpp"

namespace telltale {
namespace {

constexpr std::int64_t kSpareChunks = 100;

}  // namespace

WindowArchive::WindowArchive(WindowStore store, Fleet& fleet, const Periods& periods)
    : store_(std::move(store)),
      fleet_(fleet),
      periods_(periods),
      most_chunks_(static_cast<std::int64_t>(2.0 * periods.window_s / periods.save_s) +
                   kSpareChunks) {
  Restore();
  thread_ = std::thread([this] { Run(); });
}

WindowArchive::~WindowArchive() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  thread_.join();
  Save();
}

WindowActivity WindowArchive::Activity() const {
  WindowActivity activity;
  for (const auto& [vehicle_id, window] : fleet_.windows()) {
    const SavingState state = window->Saving();
    activity.unloaded += state.unloaded ? 1 : 0;
    activity.samples.unsaved += state.unsaved;
    activity.samples.dropped += state.dropped;
  }
  return activity;
}

void WindowArchive::Restore() {
  const auto begun = Clock::now();
  std::size_t restored = 0;
  for (const auto& [vehicle_id, window] : fleet_.windows()) {
    Admit(vehicle_id, *window);
    if (!window->Snapshot().gnss.empty()) ++restored;
  }
  if (restored == 0) return;
  const std::chrono::duration<double> took = Clock::now() - begun;
  spdlog::info("the windows of {} vehicles are read back in {:.1f} s", restored, took.count());
}

void WindowArchive::Admit(const std::string& vehicle_id, VehicleWindow& window) {
  try {
    Read(vehicle_id, [&window](const Recording& samples) { window.Restore(samples); });
  } catch (const std::exception& error) {
    spdlog::error("{}; the window of {} begins anew", error.what(), vehicle_id);
  }
  window.BeginSaving({.load = [this](const auto& of, const auto& take) { Read(of, take); },
                      .wanted = [this] { Want(); }});
}

void WindowArchive::Read(const std::string& vehicle_id,
                         const std::function<void(const Recording&)>& take) {
  const std::lock_guard lock(store_mutex_);
  const std::size_t unreadable = store_.Load(vehicle_id, take);
  if (unreadable > 0) {
    spdlog::error("{}: {} chunks of {} are damaged and passed over", store_.name(), unreadable,
                  vehicle_id);
  }
}

void WindowArchive::Run() {
  const auto period =
      std::chrono::ceil<Clock::duration>(std::chrono::duration<double>(periods_.save_s));
  auto next_save = Clock::now() + period;
  bool may_load = true;  // where it fails it is tried again after the next save
  std::unique_lock lock(mutex_);
  while (!stopping_) {
    wake_.wait_until(lock, next_save, [&] { return stopping_ || (may_load && load_wanted_); });
    load_wanted_ = false;
    lock.unlock();
    const bool is_due = Clock::now() >= next_save;
    if (is_due) Save();
    may_load = LoadWanted();
    if (is_due) {
      UnloadUnused();
      next_save = Clock::now() + period;
    }
    lock.lock();
  }
}

/// Called by who fills the windows, which must not wait.
void WindowArchive::Want() {
  {
    const std::lock_guard lock(mutex_);
    load_wanted_ = true;
  }
  wake_.notify_all();
}

void WindowArchive::Save() {
  try {
    Write();
    TakeUnsaved();
    Write();
    if (!saved_last_time_) spdlog::info("windows are saved again");
    saved_last_time_ = true;
  } catch (const std::exception& error) {
    if (saved_last_time_) {
      spdlog::error("{}; telemetry is taken in and not saved", error.what());
    }
    saved_last_time_ = false;
  }
  LogDropped();
}

void WindowArchive::TakeUnsaved() {
  std::map<int, std::vector<WindowStore::Chunk>> by_group;
  for (const auto& [vehicle_id, window] : fleet_.windows()) {
    Recording unsaved = window->TakeUnsaved();
    if (unsaved.gnss.empty() && unsaved.heading.empty() && unsaved.thrusters.empty()) continue;
    by_group[store_.GroupOf(vehicle_id)].push_back({vehicle_id, std::move(unsaved)});
  }
  for (auto& [group, chunks] : by_group) chunks_.push_back(std::move(chunks));
}

void WindowArchive::Write() {
  for (; !chunks_.empty(); chunks_.pop_front()) {
    const std::lock_guard lock(store_mutex_);
    written_.Count([this] { store_.Save(chunks_.front(), {periods_.window_s, most_chunks_}); });
  }
}

void WindowArchive::LogDropped() {
  const std::uint64_t dropped = Activity().samples.dropped;
  const std::uint64_t before = std::exchange(dropped_, dropped);
  if (dropped <= before) return;
  spdlog::error(
      "{} samples, the oldest, have gone before they were saved: they had waited for too "
      "long",
      dropped - before);
}

void WindowArchive::UnloadUnused() {
  if (periods_.unload_after_s <= 0.0 || !chunks_.empty()) return;
  const std::chrono::duration<double> unused(periods_.unload_after_s);
  std::size_t unloaded = 0;
  for (const auto& [vehicle_id, window] : fleet_.windows()) {
    unloaded += window->UnloadIfUnused(unused, Clock::now()) ? 1 : 0;
  }
  if (unloaded == 0) return;
  ReturnFreedMemory();
  spdlog::info("the windows of {} silent vehicles are unloaded; the store has them", unloaded);
}

/// False where the database refuses one.
bool WindowArchive::LoadWanted() {
  for (const auto& [vehicle_id, window] : fleet_.windows()) {
    if (!window->WaitsForLoad()) continue;
    try {
      window->Load();
      loaded_last_time_ = true;
      spdlog::info("{} sends again; its window is read back", vehicle_id);
    } catch (const std::exception& error) {
      if (std::exchange(loaded_last_time_, false)) {
        spdlog::error("{}; the window of {} is not read back yet", error.what(), vehicle_id);
      }
      return false;
    }
  }
  return true;
}

}  // namespace telltale
