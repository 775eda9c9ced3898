#include "telltale/service/web/web_server.hpp"

#include <chrono>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

#include <prometheus/text_serializer.h>
#include <spdlog/spdlog.h>

#include "telltale/client/recording/file_contents.hpp"
#include "telltale/idl/codec/json/json_message.hpp"
#include "telltale/idl/proto/fleet.pb.h"
#include "telltale/service/monitoring/fleet_json.hpp"
#include "telltale/service/supervision/liveness.hpp"
#include "telltale/service/web/bounded_connections.hpp"
#include "telltale/service/web/json_answer.hpp"
#include "telltale/service/web/page_assets.hpp"

namespace telltale {
namespace {

constexpr std::size_t kShortestToken = 16;

/// The token of the file without white space around it; nothing where no file is named.
std::optional<std::string> ReadToken(const std::string& file) {
  if (file.empty()) return std::nullopt;
  const auto text = ReadFile(file);
  if (!text) throw std::runtime_error("http.token_file " + file + ": " + text.error().reason);
  const auto first = text->find_first_not_of(" \t\r\n");
  const auto last = text->find_last_not_of(" \t\r\n");
  const std::string token = first == std::string::npos ? "" : text->substr(first, last - first + 1);
  if (token.size() < kShortestToken) {
    throw std::runtime_error("http.token_file " + file + ": a token of " +
                             std::to_string(token.size()) + " characters; it needs 16 or more");
  }
  return token;
}

std::unique_ptr<httplib::Server> MakeServer(const HttpSettings& settings) {
  if (settings.tls_chain_file.empty()) return std::make_unique<httplib::Server>();
  auto server = std::make_unique<httplib::SSLServer>(settings.tls_chain_file.c_str(),
                                                     settings.tls_key_file.c_str());
  if (!server->is_valid()) {
    throw std::runtime_error("http.tls_chain_file " + settings.tls_chain_file + ", tls_key_file " +
                             settings.tls_key_file + ": no PEM pair");
  }
  return server;
}

/// Binds, and says where: "http://127.0.0.1:8480/".
std::string Bind(httplib::Server& server, const HttpSettings& settings) {
  int port = static_cast<int>(settings.port);
  const bool bound = port == 0 ? (port = server.bind_to_any_port(settings.address)) > 0
                               : server.bind_to_port(settings.address, port);
  if (!bound) {
    throw std::runtime_error("http: cannot listen on " + settings.address + " port " +
                             std::to_string(settings.port) +
                             "; is another daemon there? http.port 0 takes any that is free");
  }
  const char* scheme = settings.tls_chain_file.empty() ? "http" : "https";
  const bool is_v6 = settings.address.find(':') != std::string::npos;
  return std::string(scheme) + "://" + (is_v6 ? "[" : "") + settings.address + (is_v6 ? "]" : "") +
         ":" + std::to_string(port) + "/";
}

/// Lets the client have gzip where it takes that, and else plain text. The library would compress
/// by the slowest quality of Brotli, which takes seconds of a processor for the list of a large
/// fleet.
void RuleOutBrotli(const httplib::Request& request) {
  // The library has no setting for it, and a request of its own that is not const.
  httplib::Headers& headers = const_cast<httplib::Request&>(request).headers;
  const bool takes_gzip =
      request.get_header_value("Accept-Encoding").find("gzip") != std::string::npos;
  headers.erase("Accept-Encoding");
  if (takes_gzip) headers.emplace("Accept-Encoding", "gzip");
}

/// The state of now, then each event; a comment in between keeps the connection.
class EventStream {
 public:
  EventStream(FleetView& view, std::uint64_t next) : view_(view), next_(next) {
    view_.events().Join();
  }
  EventStream(const EventStream&) = delete;
  EventStream& operator=(const EventStream&) = delete;
  ~EventStream() { view_.events().Leave(); }

  bool WriteNext(httplib::DataSink& sink) {
    if (!std::exchange(greeted_, true)) return Write(sink, "retry: 2000\n\n");
    const EventLog::Batch batch = view_.events().Await(next_, std::chrono::seconds(10));
    next_ = batch.next;
    if (batch.closed) return false;
    if (batch.events.empty()) return Write(sink, ": nothing new\n\n");
    for (const EventLog::Text& event : batch.events) {
      if (!Write(sink, *event)) return false;
    }
    return true;
  }

 private:
  static bool Write(httplib::DataSink& sink, const std::string& text) {
    return sink.write(text.data(), text.size());
  }

  FleetView& view_;
  std::uint64_t next_;
  bool greeted_ = false;
};

}  // namespace

WebServer::WebServer(const HttpSettings& settings, const Fleet& fleet,
                     const PublishedModels& models, const PublishedDiagnoses& diagnoses,
                     FleetView& view, std::function<DaemonActivity()> activity,
                     OrderHandlers handlers)
    : view_(view),
      activity_(std::move(activity)),
      rates_(settings.requests_per_minute),
      metrics_(view, activity_, handlers.serves),
      api_(fleet, models, diagnoses, view, std::move(handlers), ReadToken(settings.token_file)),
      server_(MakeServer(settings)) {
  Limit(settings.connections);
  PrepareRequests();
  AnswerFaults();
  AddPage();
  AddMetrics();
  AddConditions();
  AddEvents(settings.connections - settings.connections / 4);
  api_.AddRoutes(*server_);
  const std::string address = Bind(*server_, settings);
  thread_ = std::thread([this] { server_->listen_after_bind(); });
  while (!server_->is_running()) std::this_thread::yield();
  spdlog::info("the page is at {}", address);
}

WebServer::~WebServer() {
  view_.events().Close();
  server_->stop();
  thread_.join();
}

void WebServer::Limit(std::size_t connections) {
  server_->new_task_queue = [connections] { return new BoundedConnections(connections); };
  server_->set_payload_max_length(std::size_t{64} * 1024);
  server_->set_read_timeout(std::chrono::seconds(5));
  server_->set_write_timeout(std::chrono::seconds(10));
  server_->set_keep_alive_timeout(5);
  server_->set_default_headers(
      {{"X-Content-Type-Options", "nosniff"},
       {"Referrer-Policy", "no-referrer"},
       {"Content-Security-Policy",
        "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; "
        "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"}});
}

/// The limit is of what is asked; orders have one of their own.
void WebServer::PrepareRequests() {
  server_->set_pre_routing_handler(
      [this](const httplib::Request& request, httplib::Response& response) {
        using enum httplib::Server::HandlerResponse;
        RuleOutBrotli(request);
        if (request.method != "GET") return Unhandled;
        const auto wait = rates_.Wait(request.remote_addr, RequestRates::Clock::now());
        if (!wait) return Unhandled;
        response.set_header("Retry-After", std::to_string(wait->count()));
        AnswerFailure(429, "too many requests of " + request.remote_addr,
                      std::to_string(rates_.most()) + " a minute; see http.requests_per_minute",
                      response);
        return Handled;
      });
}

/// Every fault is JSON, also those that no route has answered.
void WebServer::AnswerFaults() {
  server_->set_error_handler([](const httplib::Request& request, httplib::Response& response) {
    if (!response.body.empty() || response.status == 304) return;
    if (response.status == 404) {
      return AnswerFailure(404, "there is nothing at " + request.path.substr(0, 64),
                           "a route of /api/v1/openapi.json", response);
    }
    AnswerFailure(response.status, "the request cannot be served", "", response);
  });
  server_->set_exception_handler([](const httplib::Request& request, httplib::Response& response,
                                    std::exception_ptr fault) {
    try {
      std::rethrow_exception(std::move(fault));
    } catch (const std::exception& error) {
      spdlog::error("http: {} {}: {}", request.method, request.path.substr(0, 128), error.what());
      AnswerFailure(500, error.what(), "", response);
    }
  });
}

void WebServer::AddPage() {
  for (const PageAsset& asset : PageAssets()) {
    const auto answer = [asset, tag = EntityTag(asset.body)](const httplib::Request& request,
                                                             httplib::Response& response) {
      response.set_header("ETag", tag);
      response.set_header("Cache-Control", "no-cache");
      if (HasEntity(request, tag)) {
        response.status = 304;
        return;
      }
      response.set_content(asset.body.data(), asset.body.size(), std::string(asset.type));
    };
    std::string route(asset.path);
    for (std::size_t dot = 0; (dot = route.find('.', dot)) != std::string::npos; dot += 2) {
      route.insert(dot, "\\");
    }
    server_->Get(route, answer);
    if (asset.path == "/index.html") server_->Get("/", answer);
  }
}

void WebServer::AddMetrics() {
  server_->Get("/metrics", [this](const httplib::Request&, httplib::Response& response) {
    std::ostringstream text;
    prometheus::TextSerializer().Serialize(text, metrics_.Collect());
    response.set_content(text.str(), "text/plain; version=0.0.4; charset=utf-8");
  });
}

/// What orchestrators ask for: whether to send clients here, and whether to start the daemon again.
void WebServer::AddConditions() {
  const auto add = [this](const char* route, const char* otherwise, auto holds) {
    server_->Get(route, [=, this](const httplib::Request& request, httplib::Response& response) {
      const DaemonActivity activity = activity_();
      if (!holds(activity)) {
        return AnswerFailure(503, otherwise + StatusLine(activity), "ask again", response);
      }
      proto::Condition condition;
      condition.set_status(StatusLine(activity));
      AnswerJson(condition, request, response);
    });
  };
  add("/api/v1/ready", "the daemon does not serve yet: ", [](const DaemonActivity& activity) {
    return activity.is_ready;
  });
  add("/api/v1/alive", "a thread of the daemon does not advance: ", IsAlive);
}

/// A quarter of the connections is left for all else.
void WebServer::AddEvents(std::size_t streams) {
  const auto follow = [this, streams](const httplib::Request&, httplib::Response& response) {
    if (view_.events().readers() >= static_cast<int>(streams)) {
      response.set_header("Retry-After", "5");
      return AnswerFailure(503, "too many streams of events are open",
                           std::to_string(streams) + " at a time; see http.connections", response);
    }
    Follow(response);
  };
  server_->Get("/api/v1/events", follow);
  server_->Get("/events", follow);
}

void WebServer::Follow(httplib::Response& response) {
  auto stream = std::make_shared<EventStream>(view_, view_.events().End());
  response.set_header("Cache-Control", "no-store");
  response.set_chunked_content_provider("text/event-stream",
                                        [stream](std::size_t, httplib::DataSink& sink) {
                                          if (stream->WriteNext(sink)) return true;
                                          sink.done();
                                          return false;
                                        });
}

}  // namespace telltale
