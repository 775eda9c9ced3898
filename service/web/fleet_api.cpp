#include "telltale/service/web/fleet_api.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "telltale/client/exchange/mss.hpp"
#include "telltale/client/exchange/vrx.hpp"
#include "telltale/client/fleet/request_reply.hpp"
#include "telltale/client/fleet/unix_now.hpp"
#include "telltale/client/report/report_page.hpp"
#include "telltale/core/base/version.hpp"
#include "telltale/idl/codec/json/json_message.hpp"
#include "telltale/idl/codec/json/proto_values.hpp"
#include "telltale/idl/codec/json/published.hpp"
#include "telltale/idl/codec/json/quality.hpp"
#include "telltale/idl/proto/fleet.pb.h"
#include "telltale/service/monitoring/fleet_json.hpp"
#include "telltale/service/web/json_answer.hpp"
#include "telltale/service/web/model_answers.hpp"

namespace telltale {
namespace {

constexpr std::uint64_t kMostRevision = std::numeric_limits<std::uint32_t>::max();
constexpr std::uint64_t kOrdersPerMinute = 120;

/// Compares in a time that does not depend on where the two differ.
bool IsSame(const std::string& given, const std::string& wanted) {
  unsigned difference = given.size() == wanted.size() ? 0u : 1u;
  for (std::size_t i = 0; i < given.size(); ++i) {
    difference |= static_cast<unsigned>(given[i] ^ wanted[i % wanted.size()]);
  }
  return difference == 0;
}

/// Which vehicles a list holds.
struct ListFilter {
  std::set<QualityVerdict> verdicts;  ///< empty: all
  std::string match;

  bool Holds(const Quality& quality) const {
    return (verdicts.empty() || verdicts.contains(quality.verdict)) &&
           quality.vehicle_id.find(match) != std::string::npos;
  }
};

/// `verdict` of the query, a list with commas; nothing after it has answered 400.
std::optional<ListFilter> FilterOf(const httplib::Request& request, httplib::Response& response) {
  ListFilter filter;
  filter.match = request.get_param_value("match");
  std::string names = request.get_param_value("verdict");
  while (!names.empty()) {
    const std::string name = names.substr(0, names.find(','));
    names.erase(0, name.size() + 1);
    const auto* known = std::ranges::find_if(
        kQualityVerdicts, [&](QualityVerdict verdict) { return Name(verdict) == name; });
    if (known == kQualityVerdicts.end()) {
      AnswerFailure(400, "verdict is '" + name.substr(0, 64) + "'", "OK, WARN, ERROR or STALE",
                    response);
      return std::nullopt;
    }
    filter.verdicts.insert(*known);
  }
  return filter;
}

void AnswerNotServed(const std::string& vehicle_id, httplib::Response& response) {
  AnswerFailure(404, "vehicle '" + vehicle_id.substr(0, 64) + "' is not served here",
                "an id of GET /api/v1/vehicles", response);
}

/// The page that `telltale diagnose --html` writes. Its styles stand inside it.
void AnswerReport(const PublishedDiagnosis& diagnosis, httplib::Response& response) {
  response.headers.erase("Content-Security-Policy");
  response.set_header("Content-Security-Policy",
                      "default-src 'none'; style-src 'unsafe-inline'; base-uri 'none'; "
                      "form-action 'none'; frame-ancestors 'none'");
  response.set_content(ReportPage(diagnosis.diagnosis, SourcesOf(diagnosis)),
                       "text/html; charset=utf-8");
}

proto::Model Shortened(proto::Model model) {
  model.clear_covariance();
  model.clear_thruster_time_constant_covariance();
  model.clear_parameter_covariance();
  model.clear_recording_bias();
  model.clear_joint();
  model.clear_excitation();
  model.clear_coverage_check();
  model.clear_drag_and_thrust();
  return model;
}

/// The past since `since_unix_s`, at most `most` points of it, evenly chosen.
std::vector<PastPoint> Thinned(const std::vector<PastPoint>& past, double since_unix_s,
                               std::size_t most) {
  const auto first = std::ranges::find_if(
      past, [&](const PastPoint& point) { return point.time_unix_s >= since_unix_s; });
  const auto count = static_cast<std::size_t>(past.end() - first);
  const std::size_t step = std::max<std::size_t>(1, (count + most - 1) / most);
  std::vector<PastPoint> thinned;
  for (std::size_t back = 0; back < count; back += step) {
    thinned.push_back(past[past.size() - 1 - back]);
  }
  std::ranges::reverse(thinned);
  return thinned;
}

}  // namespace

FleetApi::FleetApi(const Fleet& fleet, const PublishedModels& models,
                   const PublishedDiagnoses& diagnoses, FleetView& view, OrderHandlers handlers,
                   std::optional<std::string> token)
    : fleet_(fleet),
      models_(models),
      diagnoses_(diagnoses),
      view_(view),
      handlers_(std::move(handlers)),
      token_(std::move(token)),
      order_limit_(kOrdersPerMinute, std::chrono::minutes(1)) {}

void FleetApi::AddRoutes(httplib::Server& server) {
  const auto get = [&](const char* route,
                       void (FleetApi::*answer)(const Request&, Response&) const) {
    server.Get(route, [this, answer](const Request& request, Response& response) {
      (this->*answer)(request, response);
    });
  };
  get("/api/v1", &FleetApi::GetInfo);
  get("/api/v1/vehicles", &FleetApi::GetVehicles);
  get("/api/v1/tracks", &FleetApi::GetTracks);
  get("/api/v1/vehicles/([^/]+)", &FleetApi::GetVehicle);
  get("/api/v1/vehicles/([^/]+)/history", &FleetApi::GetHistory);
  get("/api/v1/vehicles/([^/]+)/models", &FleetApi::GetModels);
  get("/api/v1/vehicles/([^/]+)/models/([^/]+)", &FleetApi::GetModel);
  get("/api/v1/vehicles/([^/]+)/models/([^/]+)/export", &FleetApi::GetExport);
  get("/api/v1/vehicles/([^/]+)/comparison", &FleetApi::GetComparison);
  get("/api/v1/vehicles/([^/]+)/predicted-paths", &FleetApi::GetPredictedPaths);
  get("/api/v1/vehicles/([^/]+)/diagnosis", &FleetApi::GetDiagnosis);
  get("/api/v1/vehicles/([^/]+)/diagnosis/report", &FleetApi::GetReport);
  get("/api/v1/vehicles/([^/]+)/diagnoses", &FleetApi::GetDiagnoses);
  get("/api/v1/vehicles/([^/]+)/diagnoses/([^/]+)", &FleetApi::GetKeptDiagnosis);
  get("/api/v1/vehicles/([^/]+)/diagnoses/([^/]+)/report", &FleetApi::GetKeptReport);
  get("/api/v1/jobs", &FleetApi::GetJobs);
  get("/api/v1/jobs/([^/]+)", &FleetApi::GetJob);
  server.Post("/api/v1/refresh", [this](const Request& request, Response& response) {
    PostOrder(JobView::Kind::kRefresh, request, response);
  });
  server.Post("/api/v1/diagnose", [this](const Request& request, Response& response) {
    PostOrder(JobView::Kind::kDiagnose, request, response);
  });
  server.Post("/api/v1/rollback", [this](const Request& request, Response& response) {
    PostRollback(request, response);
  });
}

void FleetApi::GetInfo(const Request& request, Response& response) const {
  proto::ServerInfo info;
  info.set_version(std::string(Version()));
  info.set_vehicles(static_cast<std::uint32_t>(fleet_.windows().size()));
  info.set_read_only(!token_);
  AnswerJson(info, request, response);
}

void FleetApi::GetVehicles(const Request& request, Response& response) const {
  const auto limit = QueryCount(request, "limit", 1, 1000, 100, response);
  if (!limit) return;
  const auto filter = FilterOf(request, response);
  if (!filter) return;
  const std::string after = request.get_param_value("after");
  proto::VehicleList list;
  list.set_time_unix_s(view_.LastRoundUnixS());
  std::uint32_t total = 0;
  for (const Quality& quality : view_.Qualities()) {
    if (!filter->Holds(quality)) continue;
    ++total;
    if (!after.empty() && quality.vehicle_id <= after) continue;
    if (list.vehicles_size() < static_cast<int>(*limit)) {
      *list.add_vehicles() = SummaryOf(quality);
    } else if (list.next().empty()) {
      list.set_next(list.vehicles(list.vehicles_size() - 1).vehicle_id());
    }
  }
  list.set_total(total);
  AnswerJson(list, request, response);
}

bool FleetApi::IsServed(const std::string& vehicle_id, Response& response) const {
  if (fleet_.Find(vehicle_id) != nullptr) return true;
  AnswerNotServed(vehicle_id, response);
  return false;
}

void FleetApi::GetVehicle(const Request& request, Response& response) const {
  const std::string vehicle_id = request.matches[1];
  if (!IsServed(vehicle_id, response)) return;
  const auto timed = view_.QualityOf(vehicle_id);
  if (!timed) {
    return AnswerFailure(503, "the first quality of this vehicle is not there yet",
                         "ask again in a second", response);
  }
  AnswerJson(ToProto(timed->quality, timed->time_unix_s), request, response);
}

void FleetApi::GetHistory(const Request& request, Response& response) const {
  const std::string vehicle_id = request.matches[1];
  if (!IsServed(vehicle_id, response)) return;
  AnswerJson(ToProto(view_.PastOf(vehicle_id)), request, response);
}

void FleetApi::GetTracks(const Request& request, Response& response) const {
  const auto seconds = QueryCount(request, "seconds", 1, 3600, 600, response);
  if (!seconds) return;
  constexpr std::size_t kPoints = 60;
  const double since = UnixNow() - static_cast<double>(*seconds);
  proto::TrackList list;
  for (const auto& [vehicle_id, window] : fleet_.windows()) {
    auto& track = *list.add_tracks();
    track.set_vehicle_id(vehicle_id);
    *track.mutable_history() = ToProto(Thinned(view_.PastOf(vehicle_id), since, kPoints));
  }
  AnswerJson(list, request, response);
}

void FleetApi::GetModels(const Request& request, Response& response) const {
  const std::string vehicle_id = request.matches[1];
  if (!IsServed(vehicle_id, response)) return;
  const auto limit = QueryCount(request, "limit", 1, 100, 20, response);
  if (!limit) return;
  const auto before = QueryCount(request, "before", 1, kMostRevision, kMostRevision, response);
  if (!before) return;
  proto::ModelList list;
  for (const StoredModel& stored : models_.History(vehicle_id, *before, *limit + 1)) {
    if (list.models_size() == static_cast<int>(*limit)) {
      const auto& last = list.models(list.models_size() - 1).provenance();
      list.set_next(Saturated(last.revision()));
      break;
    }
    *list.add_models() = Shortened(ToProto(stored.model));
  }
  AnswerJson(list, request, response);
}

void FleetApi::GetModel(const Request& request, Response& response) const {
  const std::string vehicle_id = request.matches[1];
  if (!IsServed(vehicle_id, response)) return;
  const auto model = FindModel(vehicle_id, request.matches[2], response);
  if (model) AnswerJson(ToProto(*model), request, response);
}

/// The model of that revision; nothing after it has answered 404.
std::optional<PublishedModel> FleetApi::FindModel(const std::string& vehicle_id,
                                                  const std::string& text,
                                                  Response& response) const {
  const bool numeric = !text.empty() && text.size() < 10 &&
                       text.find_first_not_of("0123456789") == std::string::npos;
  const std::uint64_t revision = numeric ? std::stoull(text) : 0;
  const auto newest = models_.History(vehicle_id, revision + 1, 1);
  if (!newest.empty() && newest.front().model.revision == revision) return newest.front().model;
  AnswerFailure(404, "there is no revision '" + text.substr(0, 64) + "' of " + vehicle_id,
                "a revision of GET /api/v1/vehicles/" + vehicle_id + "/models", response);
  return std::nullopt;
}

/// For another simulator, as `telltale export` writes it.
void FleetApi::GetExport(const Request& request, Response& response) const {
  const std::string vehicle_id = request.matches[1];
  const VehicleWindow* const window = fleet_.Find(vehicle_id);
  if (window == nullptr) return AnswerNotServed(vehicle_id, response);
  const bool has_format = request.has_param("format");
  const std::string format = has_format ? request.get_param_value("format") : "mss";
  if (format != "mss" && format != "vrx") {
    return AnswerFailure(400, "format is '" + format.substr(0, 64) + "'", "mss or vrx", response);
  }
  const auto model = FindModel(vehicle_id, request.matches[2], response);
  if (!model) return;
  const bool is_mss = format == "mss";
  const Result<std::string> text = is_mss ? PrintMss(model->identification, window->vehicle())
                                          : PrintVrx(model->identification, window->vehicle());
  if (!text) {
    const Refusal& refusal = text.error();
    return AnswerFailure(404, refusal.subject + ": " + refusal.reason, refusal.advice, response);
  }
  response.set_header("Content-Disposition", "attachment; filename=\"" + vehicle_id + "-r" +
                                                 std::to_string(model->revision) +
                                                 (is_mss ? ".mss.json\"" : ".vrx.sdf\""));
  response.set_content(*text, is_mss ? "application/json" : "application/xml");
}

/// By default of the newest model with the one before it.
void FleetApi::GetComparison(const Request& request, Response& response) const {
  const std::string vehicle_id = request.matches[1];
  if (!IsServed(vehicle_id, response)) return;
  const auto newest = models_.History(vehicle_id, kMostRevision, 1);
  const std::uint64_t last = newest.empty() ? 1 : newest.front().model.revision;
  const auto later = QueryCount(request, "later", 1, kMostRevision, last, response);
  if (!later) return;
  const auto earlier = QueryCount(request, "earlier", 1, kMostRevision, *later - 1, response);
  if (!earlier) return;
  if (*earlier >= *later) {
    return AnswerFailure(
        400, "earlier is " + std::to_string(*earlier) + " and later is " + std::to_string(*later),
        "two revisions, the earlier one smaller", response);
  }
  const auto first = FindModel(vehicle_id, std::to_string(*earlier), response);
  if (!first) return;
  const auto second = FindModel(vehicle_id, std::to_string(*later), response);
  if (second) AnswerJson(Compared(*first, *second), request, response);
}

void FleetApi::GetPredictedPaths(const Request& request, Response& response) const {
  const std::string vehicle_id = request.matches[1];
  VehicleWindow* const window = fleet_.Find(vehicle_id);
  if (window == nullptr) return AnswerNotServed(vehicle_id, response);
  const auto seconds = QueryCount(request, "seconds", 10, 600, 180, response);
  if (!seconds) return;
  const auto horizon =
      QueryCount(request, "horizon", 5, *seconds, std::min<std::uint64_t>(*seconds, 60), response);
  if (!horizon) return;
  const auto latest = models_.Latest(vehicle_id);
  if (!latest) {
    return AnswerFailure(404, vehicle_id + " has no model",
                         "telltale identify --vehicle-id " + vehicle_id, response);
  }
  const std::uint64_t revision = latest->model.revision;
  const auto paths = path_predictions_.Ask({vehicle_id, revision, *seconds, *horizon}, [&] {
    return PredictPaths(window->Snapshot(), window->vehicle(), latest->model.identification,
                        static_cast<double>(*seconds), static_cast<double>(*horizon));
  });
  if (!paths) {
    response.set_header("Retry-After", "1");
    return AnswerFailure(503, "too many predicted paths are asked for", "ask again in a second",
                         response);
  }
  if (!*paths) {
    const Refusal& refusal = paths->error();
    return AnswerFailure(404, refusal.subject + ": " + refusal.reason, refusal.advice, response);
  }
  AnswerJson(ToProto(**paths, revision), request, response);
}

/// The last one; null after it has answered 404.
std::shared_ptr<const PublishedDiagnosis> FleetApi::FindDiagnosis(const std::string& vehicle_id,
                                                                  Response& response) const {
  if (!IsServed(vehicle_id, response)) return nullptr;
  auto last = view_.LastDiagnosisOf(vehicle_id);
  if (!last) {
    AnswerFailure(404, vehicle_id + " has not been diagnosed",
                  "telltale diagnose --vehicle-id " + vehicle_id, response);
  }
  return last;
}

void FleetApi::GetDiagnosis(const Request& request, Response& response) const {
  const auto last = FindDiagnosis(request.matches[1], response);
  if (last) AnswerJson(ToProto(*last), request, response);
}

void FleetApi::GetReport(const Request& request, Response& response) const {
  const auto last = FindDiagnosis(request.matches[1], response);
  if (last) AnswerReport(*last, response);
}

void FleetApi::GetDiagnoses(const Request& request, Response& response) const {
  const std::string vehicle_id = request.matches[1];
  if (!IsServed(vehicle_id, response)) return;
  AnswerJson(ToProto(diagnoses_.History(vehicle_id)), request, response);
}

/// The one that the time in the route names; nothing after it has answered 404.
std::optional<PublishedDiagnosis> FleetApi::FindKept(const Request& request,
                                                     Response& response) const {
  const std::string vehicle_id = request.matches[1];
  if (!IsServed(vehicle_id, response)) return std::nullopt;
  const std::string text = request.matches[2];
  double published_unix_s = 0.0;
  std::from_chars(text.data(), text.data() + text.size(), published_unix_s);
  for (PublishedDiagnosis& diagnosis : diagnoses_.History(vehicle_id)) {
    if (diagnosis.published_unix_s == published_unix_s) return std::move(diagnosis);
  }
  AnswerFailure(404, "there is no diagnosis '" + text.substr(0, 64) + "' of " + vehicle_id,
                "publishedUnixS of GET /api/v1/vehicles/" + vehicle_id + "/diagnoses", response);
  return std::nullopt;
}

void FleetApi::GetKeptDiagnosis(const Request& request, Response& response) const {
  const auto diagnosis = FindKept(request, response);
  if (diagnosis) AnswerJson(ToProto(*diagnosis), request, response);
}

void FleetApi::GetKeptReport(const Request& request, Response& response) const {
  const auto diagnosis = FindKept(request, response);
  if (diagnosis) AnswerReport(*diagnosis, response);
}

void FleetApi::GetJobs(const Request& request, Response& response) const {
  const auto limit = QueryCount(request, "limit", 1, 512, 50, response);
  if (!limit) return;
  const std::string vehicle_id = request.get_param_value("vehicle");
  proto::JobList list;
  for (const JobView& job : view_.Jobs()) {
    if (!vehicle_id.empty() && job.vehicle_id != vehicle_id) continue;
    if (list.jobs_size() == static_cast<int>(*limit)) break;
    *list.add_jobs() = ToProto(job);
  }
  AnswerJson(list, request, response);
}

void FleetApi::GetJob(const Request& request, Response& response) const {
  const std::string id = request.matches[1];
  const auto job = view_.JobOf(id);
  if (!job) {
    return AnswerFailure(404, "there is no request '" + id.substr(0, 64) + "'",
                         "an id of GET /api/v1/jobs", response);
  }
  AnswerJson(ToProto(*job), request, response);
}

/// Whether the request may change anything; answers it where it may not.
bool FleetApi::IsAllowed(const Request& request, Response& response) {
  if (!token_) {
    AnswerFailure(403, "this daemon is read-only over HTTP",
                  "http.token_file in the configuration of telltaled", response);
    return false;
  }
  if (!IsSame(request.get_header_value("Authorization"), "Bearer " + *token_)) {
    response.set_header("WWW-Authenticate", "Bearer");
    AnswerFailure(401, "the token is missing or wrong", "Authorization: Bearer TOKEN", response);
    return false;
  }
  const std::lock_guard lock(limit_mutex_);
  if (order_limit_.Admit(std::chrono::steady_clock::now())) return true;
  response.set_header("Retry-After", "60");
  AnswerFailure(429, "too many orders", "120 a minute", response);
  return false;
}

/// Whether the request is an order of this form that may be carried out; answers it where it is
/// not.
bool FleetApi::ReadOrder(const Request& request, const std::string& form,
                         google::protobuf::Message& order, Response& response) {
  if (!IsAllowed(request, response)) return false;
  if (!handlers_.serves()) {
    AnswerFailure(503, "this daemon stands by for another", "the daemon that serves", response);
    return false;
  }
  if (request.get_header_value("Content-Type").rfind("application/json", 0) != 0) {
    AnswerFailure(415, "the body is no JSON", "Content-Type: application/json", response);
    return false;
  }
  const auto fault = ParseJsonMessage(request.body, "body", order);
  if (fault) AnswerFailure(400, fault->Message(), form, response);
  return !fault;
}

void FleetApi::PostOrder(JobView::Kind kind, const Request& request, Response& response) {
  proto::Order order;
  if (!ReadOrder(request, "{\"vehicleId\": \"ID\"}", order, response)) return;
  if (!IsServed(order.vehicle_id(), response)) return;
  const std::string id = NewCorrelationId();
  const JobView job = view_.Begin(kind, id, order.vehicle_id());
  Queue(kind, id, order.vehicle_id());
  response.status = 202;
  response.set_header("Location", "/api/v1/jobs/" + id);
  AnswerJson(ToProto(job), request, response);
}

void FleetApi::PostRollback(const Request& request, Response& response) {
  proto::RollbackOrder order;
  if (!ReadOrder(request, "{\"vehicleId\": \"ID\", \"revision\": N}", order, response)) return;
  if (!IsServed(order.vehicle_id(), response)) return;
  const auto model = handlers_.rollback(order.vehicle_id(), order.revision());
  if (!model) {
    return AnswerFailure(
        404,
        "there is no revision " + std::to_string(order.revision()) + " of " + order.vehicle_id(),
        "a revision of GET /api/v1/vehicles/" + order.vehicle_id() + "/models", response);
  }
  response.set_header("Location", "/api/v1/vehicles/" + order.vehicle_id() + "/models/" +
                                      std::to_string(model->revision));
  AnswerJson(Shortened(ToProto(*model)), request, response);
}

void FleetApi::Queue(JobView::Kind kind, const std::string& id, const std::string& vehicle_id) {
  if (kind == JobView::Kind::kRefresh) {
    IdentifyRequest identify;
    identify.correlation_id = id;
    identify.vehicle_id = vehicle_id;
    return handlers_.identify(std::move(identify));
  }
  DiagnoseRequest diagnose;
  diagnose.correlation_id = id;
  diagnose.vehicle_id = vehicle_id;
  handlers_.diagnose(std::move(diagnose));
}

}  // namespace telltale
