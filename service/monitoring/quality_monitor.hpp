#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>

#include "telltale/client/bus/participant.hpp"
#include "telltale/client/bus/writer.hpp"
#include "telltale/idl/codec/messages/quality.hpp"
#include "telltale/service/ingest/fleet.hpp"
#include "telltale/service/models/published_models.hpp"
#include "telltale/service/monitoring/drift_detector.hpp"
#include "telltale/service/monitoring/live_estimator.hpp"

namespace telltale {

/// Publishes the quality of every vehicle's telemetry and model each period, on a thread of its
/// own, and a vehicle's counts in between where a receipt is due: a replay paces itself by them.
class QualityMonitor {
 public:
  QualityMonitor(const Participant& participant, Fleet& fleet, PublishedModels& models,
                 double period_s);
  QualityMonitor(const QualityMonitor&) = delete;
  QualityMonitor& operator=(const QualityMonitor&) = delete;
  ~QualityMonitor();  ///< ends the thread

  /// Publishes this vehicle's counts soon. Returns at once; any thread may call it.
  void PublishReceipt(VehicleWindow& window);

 private:
  /// What has to be remembered of a vehicle from one period to the next.
  struct Memory {
    std::uint64_t published = 0;
    WindowState window;
    Quality quality;                       ///< as published last
    double evaluated_to_s = 0.0;           ///< boat time of the newest sample evaluated
    std::uint64_t evaluated_revision = 0;  ///< of the model evaluated
    std::optional<double> prediction_error;
    double drift = 0.0;
    DriftDetector drift_detector;
    bool proposed = false;  ///< a diagnosis, by the log
    LiveEstimator live;
    std::vector<IndicativeCoefficient> indicative;
  };

  using Clock = std::chrono::steady_clock;

  void Run();
  bool WaitUntil(Clock::time_point deadline);  ///< false once it is to stop
  void PublishAll(double elapsed_s);
  void PublishReceipts();
  Quality Assess(VehicleWindow& window, Memory& memory, double elapsed_s);
  static void Follow(VehicleWindow& window, const WindowState& state, Memory& memory);
  void Evaluate(VehicleWindow& window, const WindowState& state, const StoredModel& model,
                Memory& memory);
  static std::string Propose(const Quality& quality, Memory& memory);

  Fleet& fleet_;
  PublishedModels& models_;
  const std::chrono::duration<double> period_;
  Writer<telltale_wire_Quality> writer_;
  std::map<std::string, Memory> memories_;
  std::uint64_t unattributed_published_ = 0;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool stopping_ = false;
  std::set<VehicleWindow*> receipts_due_;  ///< guarded by mutex_
  std::thread thread_;
};

}  // namespace telltale
