#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <thread>

#include "telltale/client/bus/participant.hpp"
#include "telltale/client/bus/writer.hpp"
#include "telltale/service/ingest/fleet.hpp"
#include "telltale/service/models/published_models.hpp"
#include "telltale/service/monitoring/fleet_view.hpp"
#include "telltale/service/monitoring/vehicle_monitor.hpp"
#include "telltale/service/role.hpp"
#include "telltale/service/storage/store_status.hpp"

namespace telltale {

/// Publishes the quality of every vehicle's telemetry and model once a period, on a thread of its
/// own, and a vehicle's counts in between where a receipt is due: a replay paces itself by them.
/// A fault of one period is logged, and the next period goes on. While the daemon does not serve,
/// the view alone gets the qualities.
class QualityPublisher {
 public:
  QualityPublisher(const Participant& participant, const Role& role, Fleet& fleet,
                   PublishedModels& models, FleetView& view, const StoreStatus& status,
                   double period_s);
  QualityPublisher(const QualityPublisher&) = delete;
  QualityPublisher& operator=(const QualityPublisher&) = delete;
  ~QualityPublisher();  ///< ends the thread

  /// Publishes this vehicle's counts soon. Returns at once; any thread may call it.
  void PublishReceipt(VehicleWindow& window);

  /// How many monitors this daemon is connected to.
  std::uint32_t Matched() const { return writer_.Matched(); }

 private:
  using Clock = std::chrono::steady_clock;

  void Run();
  bool WaitUntil(Clock::time_point deadline);  ///< false once it is to stop
  void PublishAll(double elapsed_s);
  void PublishReceipts();
  void AnnounceRound();  ///< to those who follow the events
  void Publish(const Quality& quality);
  Quality Unattributed();

  const Role& role_;
  Fleet& fleet_;
  PublishedModels& models_;
  FleetView& view_;  ///< takes each quality too
  const StoreStatus& status_;
  const std::chrono::duration<double> period_;
  Writer<telltale_wire_Quality> writer_;
  std::map<std::string, VehicleMonitor> monitors_;  ///< by vehicle id
  std::uint64_t unattributed_published_ = 0;
  std::mutex mutex_;  // of stopping_ and receipts_due_
  std::condition_variable wake_;
  bool stopping_ = false;
  std::set<VehicleWindow*> receipts_due_;
  std::thread thread_;
};

}  // namespace telltale
