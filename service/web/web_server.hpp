#pragma once

#include <functional>
#include <memory>
#include <thread>

#include "telltale/idl/codec/daemon_config.hpp"
#include "telltale/service/monitoring/daemon_activity.hpp"
#include "telltale/service/web/fleet_api.hpp"
#include "telltale/service/web/fleet_metrics.hpp"
#include "telltale/service/web/httplib.hpp"
#include "telltale/service/web/request_rates.hpp"

namespace telltale {

/// Serves the page, /api/v1, its events and /metrics from construction to destruction, on threads
/// of its own. Throws std::runtime_error, which names the setting, where it cannot.
class WebServer {
 public:
  WebServer(const HttpSettings& settings, const Fleet& fleet, const PublishedModels& models,
            const PublishedDiagnoses& diagnoses, FleetView& view,
            std::function<DaemonActivity()> activity, OrderHandlers handlers);
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;
  ~WebServer();

 private:
  void Limit(std::size_t connections);
  void PrepareRequests();
  void AddPage();
  void AddMetrics();
  void AddConditions();
  void AddEvents(std::size_t streams);
  void Follow(httplib::Response& response);
  void AnswerFaults();

  FleetView& view_;
  const std::function<DaemonActivity()> activity_;
  RequestRates rates_;
  FleetMetrics metrics_;
  FleetApi api_;
  std::unique_ptr<httplib::Server> server_;
  std::thread thread_;
};

}  // namespace telltale
