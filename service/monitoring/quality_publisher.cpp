#include "telltale/service/monitoring/quality_publisher.hpp"

#include <exception>
#include <utility>

#include <spdlog/spdlog.h>

#include "telltale/client/fleet/unix_now.hpp"
#include "telltale/idl/codec/json/json_message.hpp"
#include "telltale/idl/codec/wire/quality.hpp"
#include "telltale/service/monitoring/fleet_json.hpp"

namespace telltale {
namespace {

/// Monitoring goes on after a failure, which the log names.
template <class Work>
void LoggingFailure(Work work) {
  try {
    work();
  } catch (const std::exception& error) {
    spdlog::error("monitoring: {}", error.what());
  }
}

}  // namespace

QualityPublisher::QualityPublisher(const Participant& participant, const Role& role, Fleet& fleet,
                                   PublishedModels& models, FleetView& view,
                                   const StoreStatus& status, double period_s)
    : role_(role),
      fleet_(fleet),
      models_(models),
      view_(view),
      status_(status),
      period_(period_s),
      writer_(participant),
      thread_([this] { Run(); }) {}

QualityPublisher::~QualityPublisher() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

void QualityPublisher::PublishReceipt(VehicleWindow& window) {
  {
    const std::lock_guard lock(mutex_);
    receipts_due_.insert(&window);
  }
  wake_.notify_all();
}

void QualityPublisher::Run() {
  auto last = Clock::now();
  const auto period = std::chrono::ceil<Clock::duration>(period_);
  while (WaitUntil(last + period)) {
    const auto now = Clock::now();
    LoggingFailure([&] {
      PublishAll(std::chrono::duration<double>(now - last).count());
      models_.PublishBlocked();
    });
    last = now;
  }
}

bool QualityPublisher::WaitUntil(Clock::time_point deadline) {
  std::unique_lock lock(mutex_);
  while (!stopping_ && Clock::now() < deadline) {
    wake_.wait_until(lock, deadline, [this] { return stopping_ || !receipts_due_.empty(); });
    if (stopping_ || receipts_due_.empty()) continue;
    lock.unlock();
    LoggingFailure([this] { PublishReceipts(); });
    lock.lock();
  }
  return !stopping_;
}

void QualityPublisher::PublishReceipts() {
  std::set<VehicleWindow*> due;
  {
    const std::lock_guard lock(mutex_);
    std::swap(due, receipts_due_);
  }
  for (VehicleWindow* window : due) {
    Publish(monitors_[window->vehicle().vehicle_id].Receipt(*window));
  }
}

void QualityPublisher::PublishAll(double elapsed_s) {
  const auto store_fault = status_.Fault();
  const double began_unix_s = UnixNow();
  const Fleet::Windows windows = fleet_.windows();
  std::erase_if(monitors_, [&](const auto& kept) { return !windows.contains(kept.first); });
  for (const auto& [vehicle_id, window] : windows) {
    const auto latest = models_.Latest(vehicle_id);
    const Quality quality =
        monitors_[vehicle_id].Assess(*window, latest, view_, store_fault, elapsed_s);
    Publish(quality);
    view_.TakeDrift(vehicle_id, monitors_[vehicle_id].DriftOnsetS());
    view_.Take(quality, UnixNow());
  }
  const Quality unattributed = Unattributed();
  Publish(unattributed);
  view_.EndRound(began_unix_s, UnixNow(), unattributed.rejected);
  AnnounceRound();
}

void QualityPublisher::Publish(const Quality& quality) {
  if (role_.Serves()) writer_.Write(Encode(quality));
}

void QualityPublisher::AnnounceRound() {
  if (!view_.events().HasReaders()) return;
  proto::VehicleList list;
  list.set_time_unix_s(UnixNow());
  for (const Quality& quality : view_.Qualities()) *list.add_vehicles() = SummaryOf(quality);
  list.set_total(static_cast<std::uint32_t>(list.vehicles_size()));
  view_.events().Add("fleet", PrintJsonLine(list));
}

Quality QualityPublisher::Unattributed() {
  Quality quality;
  quality.vehicle_id = kUnattributed;
  quality.sequence_number = ++unattributed_published_;
  quality.rejected = fleet_.Unattributed();
  return quality;
}

}  // namespace telltale
