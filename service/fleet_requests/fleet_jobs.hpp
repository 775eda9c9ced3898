#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "telltale/client/bus/bus_log.hpp"
#include "telltale/idl/codec/fleet_slices.hpp"
#include "telltale/idl/codec/messages/fleet_exchange.hpp"
#include "telltale/service/diagnosis/published_diagnoses.hpp"
#include "telltale/service/ingest/fleet.hpp"
#include "telltale/service/jobs/exchange_history.hpp"
#include "telltale/service/jobs/reply_publisher.hpp"
#include "telltale/service/jobs/request_journal.hpp"
#include "telltale/service/models/published_models.hpp"
#include "telltale/service/refresh/refresh_run.hpp"

namespace telltale {

/// Answers requests about many vehicles or their earlier models, on a thread of its own. A refresh
/// submits a few identifications at a time, so that the queue of identifications stays short, and
/// publishes what becomes of each vehicle. It goes on where its client leaves, and after a restart
/// of the daemon; vehicles that were through by then are unchanged. The latest 64 refreshes can be
/// followed. Each answer says for which slices of the fleet it is; a daemon that has none is
/// silent.
class FleetJobs {
 public:
  struct Identifications {
    /// Submits an identification as a part of a refresh; `answer` runs on another thread.
    std::function<void(IdentifyRequest, std::function<void(const IdentifyReply&)> answer)> submit;
    std::function<bool(const std::string& correlation_id)> cancel;  ///< of any kind of request
  };

  /// `served` says which slices the daemon serves; it runs on the thread.
  FleetJobs(Fleet& fleet, PublishedModels& models, const PublishedDiagnoses& diagnoses,
            ReplyPublisher& replies, RequestJournal& journal, std::function<SliceSet()> served,
            Identifications identifications);
  FleetJobs(const FleetJobs&) = delete;
  FleetJobs& operator=(const FleetJobs&) = delete;

  /// Ends the thread. Refreshes under way get a failed reply.
  ~FleetJobs();

  /// Returns at once. Answers go out by ReplyPublisher. More than 1000 requests do not wait: who
  /// asks then is told to ask again later.
  void Submit(FleetRequest request);

  /// Answers a refresh of a run before as failed, for this reason. Returns at once.
  void GiveUp(FleetRequest refresh, std::string reason);

 private:
  /// What arrives for the thread. Identifications that end after this object hold it too.
  struct Inbox {
    std::mutex mutex;
    std::condition_variable wake;
    bool stopping = false;
    std::deque<FleetRequest> requests;
    RateLimit log_limit{200, std::chrono::seconds(10)};         ///< of requests turned away
    std::deque<FleetRequest> kept;                              ///< refreshes that are on disk
    std::deque<std::pair<FleetRequest, std::string>> given_up;  ///< and why
    /// What became of identifications: the refresh, and its vehicle.
    std::deque<std::pair<std::string, RefreshedVehicle>> outcomes;
  };

  using Runs = std::map<std::string, std::unique_ptr<RefreshRun>>;

  void Run();
  void Answer(const FleetRequest& request);
  void Take(const std::string& run_id, const RefreshedVehicle& vehicle);
  FleetReply AnswerTo(const FleetRequest& request);
  FleetReply HistoryOf(const FleetRequest& request) const;
  FleetReply ModelsOf(const FleetRequest& request) const;
  FleetReply DiagnosesOf(const FleetRequest& request) const;
  FleetReply RollbackOf(const FleetRequest& request);
  FleetReply CancelOf(const FleetRequest& request);
  void KeepRefresh(const FleetRequest& request, SliceSet slices);
  void BeginRefresh(const FleetRequest& request);
  void AnswerGivenUp(const FleetRequest& request, const std::string& reason);
  void Follow(const FleetRequest& request, SliceSet slices);
  void Reply(FleetReply reply, SliceSet slices);
  void TurnAway(const FleetRequest& request, std::optional<std::uint64_t> not_shown);
  void ReplyTo(const RefreshRun& run, const std::string& correlation_id);
  void Report(const RefreshRun& run, const std::vector<RefreshedVehicle>& vehicles,
              const std::string& correlation_id);
  void Advance();
  void Begin(RefreshRun& run, const std::string& vehicle_id);
  void End(RefreshRun& run);
  std::string UnchangedReason(const std::string& vehicle_id) const;

  Fleet& fleet_;
  PublishedModels& models_;
  const PublishedDiagnoses& diagnoses_;
  ReplyPublisher& replies_;
  RequestJournal& journal_;  ///< keeps refreshes
  const std::function<SliceSet()> served_;
  const Identifications identifications_;

  std::map<std::string, FleetReply> answered_;  ///< by correlation id; of the thread alone
  std::deque<std::string> answered_order_;
  Runs runs_;  ///< by correlation id; of the thread alone, as what follows
  std::deque<std::string> finished_runs_;
  std::map<std::string, std::string> running_;  ///< identification by refresh and vehicle

  const std::shared_ptr<Inbox> inbox_;
  std::thread thread_;
};

}  // namespace telltale
