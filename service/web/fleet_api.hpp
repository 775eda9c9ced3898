#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <google/protobuf/message.h>

#include "telltale/client/bus/bus_log.hpp"
#include "telltale/idl/codec/messages/exchange.hpp"
#include "telltale/service/diagnosis/published_diagnoses.hpp"
#include "telltale/service/ingest/fleet.hpp"
#include "telltale/service/models/published_models.hpp"
#include "telltale/service/monitoring/fleet_view.hpp"
#include "telltale/service/web/httplib.hpp"
#include "telltale/service/web/path_predictions.hpp"

namespace telltale {

/// What carries out the orders that come over HTTP.
struct OrderHandlers {
  std::function<bool()> serves;                   ///< a standby carries out none
  std::function<void(IdentifyRequest)> identify;  ///< queues the request
  std::function<void(DiagnoseRequest)> diagnose;  ///< likewise
  /// Publishes the revision again, as PublishedModels::Rollback().
  std::function<std::optional<PublishedModel>(const std::string& vehicle_id,
                                              std::uint64_t revision)>
      rollback;
};

/// The routes of /api/v1 but for the events, docs/reference/openapi.json. Every answer is JSON, by
/// the messages of idl/proto; a fault is a proto::Failure. Orders need the token; without a
/// token the API is read-only. Safe to use from several threads.
class FleetApi {
 public:
  FleetApi(const Fleet& fleet, const PublishedModels& models, const PublishedDiagnoses& diagnoses,
           FleetView& view, OrderHandlers handlers, std::optional<std::string> token);

  void AddRoutes(httplib::Server& server);

 private:
  using Request = httplib::Request;
  using Response = httplib::Response;

  void GetInfo(const Request& request, Response& response) const;
  void GetVehicles(const Request& request, Response& response) const;
  void GetVehicle(const Request& request, Response& response) const;
  void GetHistory(const Request& request, Response& response) const;
  void GetTracks(const Request& request, Response& response) const;
  void GetModels(const Request& request, Response& response) const;
  void GetModel(const Request& request, Response& response) const;
  void GetExport(const Request& request, Response& response) const;
  void GetComparison(const Request& request, Response& response) const;
  void GetPredictedPaths(const Request& request, Response& response) const;
  void GetDiagnosis(const Request& request, Response& response) const;
  void GetReport(const Request& request, Response& response) const;
  void GetDiagnoses(const Request& request, Response& response) const;
  void GetKeptDiagnosis(const Request& request, Response& response) const;
  void GetKeptReport(const Request& request, Response& response) const;
  void GetJobs(const Request& request, Response& response) const;
  void GetJob(const Request& request, Response& response) const;
  void PostOrder(JobView::Kind kind, const Request& request, Response& response);
  void PostRollback(const Request& request, Response& response);
  bool IsAllowed(const Request& request, Response& response);
  bool ReadOrder(const Request& request, const std::string& form, google::protobuf::Message& order,
                 Response& response);
  bool IsServed(const std::string& vehicle_id, Response& response) const;
  std::shared_ptr<const PublishedDiagnosis> FindDiagnosis(const std::string& vehicle_id,
                                                          Response& response) const;
  std::optional<PublishedDiagnosis> FindKept(const Request& request, Response& response) const;
  std::optional<PublishedModel> FindModel(const std::string& vehicle_id, const std::string& text,
                                          Response& response) const;
  void Queue(JobView::Kind kind, const std::string& id, const std::string& vehicle_id);

  const Fleet& fleet_;
  const PublishedModels& models_;
  const PublishedDiagnoses& diagnoses_;
  FleetView& view_;
  const OrderHandlers handlers_;
  const std::optional<std::string> token_;
  mutable PathPredictions path_predictions_;  ///< keeps its answers for a while
  std::mutex limit_mutex_;
  RateLimit order_limit_;
};

}  // namespace telltale
