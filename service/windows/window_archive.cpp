#include "telltale/service/windows/window_archive.hpp"

#include <chrono>
#include <exception>
#include <utility>
#include <vector>

#include <spdlog/spdlog.h>

namespace telltale {
namespace {

constexpr std::int64_t kSpareChunks = 100;

}  // namespace

WindowArchive::WindowArchive(WindowStore store, Fleet& fleet, double window_s, double period_s)
    : store_(std::move(store)),
      fleet_(fleet),
      window_s_(window_s),
      most_chunks_(static_cast<std::int64_t>(2.0 * window_s / period_s) + kSpareChunks),
      period_(period_s),
      most_rounds_(static_cast<std::size_t>(window_s / period_s) + 1) {
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

void WindowArchive::Restore() {
  const auto begun = std::chrono::steady_clock::now();
  std::size_t restored = 0;
  for (const auto& [vehicle_id, window] : fleet_.windows()) {
    Admit(vehicle_id, *window);
    if (!window->Snapshot().gnss.empty()) ++restored;
  }
  if (restored == 0) return;
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begun;
  spdlog::info("the windows of {} vehicles are read back in {:.1f} s", restored, took.count());
}

void WindowArchive::Admit(const std::string& vehicle_id, VehicleWindow& window) {
  try {
    Restore(vehicle_id, window);
  } catch (const std::exception& error) {
    spdlog::error("{}; the window of {} begins anew", error.what(), vehicle_id);
  }
  window.BeginSaving();
}

void WindowArchive::Restore(const std::string& vehicle_id, VehicleWindow& window) {
  const std::lock_guard lock(store_mutex_);
  const std::size_t unreadable =
      store_.Load(vehicle_id, [&window](const Recording& samples) { window.Restore(samples); });
  if (unreadable > 0) {
    spdlog::error("{}: {} chunks of {} are damaged and passed over", store_.name(), unreadable,
                  vehicle_id);
  }
}

void WindowArchive::Run() {
  std::unique_lock lock(mutex_);
  while (!stopping_) {
    wake_.wait_for(lock, period_, [this] { return stopping_; });
    lock.unlock();
    Save();
    lock.lock();
  }
}

void WindowArchive::Save() {
  TakeRound();
  if (rounds_.empty()) return;
  try {
    SaveRounds();
    if (!saved_last_time_) spdlog::info("windows are saved again");
    saved_last_time_ = true;
  } catch (const std::exception& error) {
    if (saved_last_time_) {
      spdlog::error("{}; telemetry is taken in and not saved", error.what());
    }
    saved_last_time_ = false;
  }
}

void WindowArchive::TakeRound() {
  std::vector<WindowStore::Chunk> chunks;
  for (const auto& [vehicle_id, window] : fleet_.windows()) {
    Recording unsaved = window->TakeUnsaved();
    if (unsaved.gnss.empty() && unsaved.heading.empty() && unsaved.thrusters.empty()) continue;
    chunks.push_back({vehicle_id, std::move(unsaved)});
  }
  if (!chunks.empty()) rounds_.push_back(std::move(chunks));
  if (rounds_.size() > most_rounds_) rounds_.pop_front();
}

void WindowArchive::SaveRounds() {
  const std::lock_guard lock(store_mutex_);
  for (; !rounds_.empty(); rounds_.pop_front()) {
    written_.Count([this] { store_.Save(rounds_.front(), {window_s_, most_chunks_}); });
  }
}

}  // namespace telltale
