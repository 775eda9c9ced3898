#include "telltale/service/fleet_requests/fleet_jobs.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

#include <spdlog/spdlog.h>

#include "telltale/client/fleet/request_reply.hpp"
#include "telltale/service/fleet_requests/fleet_summaries.hpp"

namespace telltale {
namespace {

constexpr std::size_t kRequestsThatWait = 1000;
constexpr std::size_t kKeptAnswers = 64;  // of refreshes and of other requests
constexpr std::size_t kAtATime = 4;       // identifications of one refresh in the queue
constexpr auto kReportPeriod = std::chrono::milliseconds(200);
constexpr double kUnchangedWithinS = 5.0;
constexpr double kAskAgainS = 5.0;

FleetReply ReplyWith(const FleetRequest& request, ReplyOutcome outcome,
                     const std::string& message = {}) {
  FleetReply reply;
  reply.correlation_id = request.correlation_id;
  reply.outcome = outcome;
  reply.message = message;
  return reply;
}

/// In full, which is too large to be kept for who asks again.
bool IsForStandby(FleetCommand command) {
  return command == FleetCommand::kModels || command == FleetCommand::kDiagnoses;
}

FleetReply NotServed(const FleetRequest& request, const Fleet& fleet) {
  return ReplyWith(request, ReplyOutcome::kFailed, fleet.NotServed(request.vehicle_ids.front()));
}

RefreshedVehicle OutcomeOfVehicle(const std::string& vehicle_id, const IdentifyReply& reply) {
  RefreshedVehicle vehicle;
  vehicle.vehicle_id = vehicle_id;
  if (reply.retry_after_s > 0.0) {  // the queue is full of other requests
    vehicle.state = RefreshState::kWaiting;
    return vehicle;
  }
  switch (reply.outcome) {
    case ReplyOutcome::kPublished:
      vehicle.state = RefreshState::kPublished;
      vehicle.revision = reply.model->revision;
      vehicle.verdict = reply.model->promotion.verdict;
      vehicle.reason = reply.model->promotion.reason;
      break;
    case ReplyOutcome::kRefused:
      vehicle.state = RefreshState::kRefused;
      if (!reply.refusals.empty())
        vehicle.reason = reply.refusals.front().subject + ": " + reply.refusals.front().reason;
      break;
    default: vehicle.state = RefreshState::kFailed; vehicle.reason = reply.message;
  }
  return vehicle;
}

}  // namespace

FleetJobs::FleetJobs(Fleet& fleet, PublishedModels& models, const PublishedDiagnoses& diagnoses,
                     ReplyPublisher& replies, RequestJournal& journal,
                     std::function<SliceSet()> served, Identifications identifications)
    : fleet_(fleet),
      models_(models),
      diagnoses_(diagnoses),
      replies_(replies),
      journal_(journal),
      served_(std::move(served)),
      identifications_(std::move(identifications)),
      inbox_(std::make_shared<Inbox>()),
      thread_([this] { Run(); }) {}

FleetJobs::~FleetJobs() {
  {
    const std::lock_guard lock(inbox_->mutex);
    inbox_->stopping = true;
  }
  inbox_->wake.notify_all();
  thread_.join();
  for (const auto& [id, run] : runs_) {
    if (run->finished()) continue;
    journal_.Drop(id);
    for (const std::string& follower : run->followers()) {
      FleetReply reply;
      reply.correlation_id = follower;
      reply.outcome = ReplyOutcome::kFailed;
      reply.message = "the daemon is stopping";
      reply.refreshed = run->vehicles();
      reply.slices = run->slices();
      replies_.Send(reply);
    }
  }
}

void FleetJobs::Submit(FleetRequest request) {
  {
    std::unique_lock lock(inbox_->mutex);
    if (inbox_->requests.size() >= kRequestsThatWait) {
      const auto not_shown = inbox_->log_limit.Admit(std::chrono::steady_clock::now());
      lock.unlock();
      return TurnAway(request, not_shown);
    }
    inbox_->requests.push_back(std::move(request));
  }
  inbox_->wake.notify_all();
}

void FleetJobs::GiveUp(FleetRequest refresh, std::string reason) {
  {
    const std::lock_guard lock(inbox_->mutex);
    inbox_->given_up.emplace_back(std::move(refresh), std::move(reason));
  }
  inbox_->wake.notify_all();
}

/// `not_shown`: how many before it were not logged; nothing where this one is not to be either.
void FleetJobs::TurnAway(const FleetRequest& request, std::optional<std::uint64_t> not_shown) {
  FleetReply busy = ReplyWith(request, ReplyOutcome::kFailed,
                              fmt::format("{} requests wait already; ask again in {:.0f} s",
                                          kRequestsThatWait, kAskAgainS));
  busy.retry_after_s = kAskAgainS;
  if (not_shown) {
    spdlog::warn("{} for {} is turned away: {} ({} more not shown)", Name(request.command),
                 request.correlation_id, busy.message, *not_shown);
  }
  replies_.Send(busy);
}

void FleetJobs::Run() {
  auto next_report = std::chrono::steady_clock::now();
  Inbox& inbox = *inbox_;
  std::unique_lock lock(inbox.mutex);
  while (!inbox.stopping) {
    const bool under_way =
        std::ranges::any_of(runs_, [](const auto& entry) { return !entry.second->finished(); });
    const auto something = [&inbox] {
      return inbox.stopping || !inbox.requests.empty() || !inbox.kept.empty() ||
             !inbox.given_up.empty() || !inbox.outcomes.empty();
    };
    under_way ? void(inbox.wake.wait_until(lock, next_report, something))
              : inbox.wake.wait(lock, something);
    const auto requests = std::exchange(inbox.requests, {});
    const auto kept = std::exchange(inbox.kept, {});
    const auto given_up = std::exchange(inbox.given_up, {});
    const auto outcomes = std::exchange(inbox.outcomes, {});
    lock.unlock();
    for (const auto& [run_id, vehicle] : outcomes) Take(run_id, vehicle);
    for (const auto& [request, reason] : given_up) AnswerGivenUp(request, reason);
    for (const FleetRequest& request : requests) Answer(request);
    for (const FleetRequest& request : kept) BeginRefresh(request);
    if (std::chrono::steady_clock::now() >= next_report || !outcomes.empty()) {
      Advance();
      next_report = std::chrono::steady_clock::now() + kReportPeriod;
    }
    lock.lock();
  }
}

void FleetJobs::Take(const std::string& run_id, const RefreshedVehicle& vehicle) {
  running_.erase(run_id + ' ' + vehicle.vehicle_id);
  const auto run = runs_.find(run_id);
  if (run != runs_.end()) run->second->Update(vehicle);
}

/// Every fault of a request ends in its reply. Whoever takes the slices of this daemon meanwhile
/// answers for them too.
void FleetJobs::Answer(const FleetRequest& request) {
  const SliceSet slices = served_();
  if (slices == 0) return;
  if (const auto known = answered_.find(request.correlation_id); known != answered_.end()) {
    return replies_.Send(known->second);
  }
  if (const auto run = runs_.find(request.correlation_id); run != runs_.end()) {
    return run->second->finished()
               ? ReplyTo(*run->second, request.correlation_id)
               : Report(*run->second, run->second->vehicles(), request.correlation_id);
  }
  if (request.command == FleetCommand::kRefresh) return KeepRefresh(request, slices);
  if (request.command == FleetCommand::kFollow) return Follow(request, slices);
  FleetReply reply;
  try {
    reply = AnswerTo(request);
  } catch (const std::exception& error) {
    reply = ReplyWith(request, ReplyOutcome::kFailed, error.what());
    spdlog::error("{} for {}: {}", Name(request.command), request.correlation_id, error.what());
  }
  // What a standby copies is too large to be kept for who asks again.
  if (!IsForStandby(request.command)) return Reply(std::move(reply), slices);
  reply.slices = slices;
  replies_.Send(reply);
}

FleetReply FleetJobs::AnswerTo(const FleetRequest& request) {
  const bool of_one = request.command == FleetCommand::kHistory || IsForStandby(request.command) ||
                      request.command == FleetCommand::kRollback;
  if (of_one && request.vehicle_ids.size() != 1) {
    return ReplyWith(
        request, ReplyOutcome::kFailed,
        "vehicle_ids = " + std::to_string(request.vehicle_ids.size()) + " items: one vehicle");
  }
  switch (request.command) {
    case FleetCommand::kList: {
      FleetReply reply = ReplyWith(request, ReplyOutcome::kAnswered);
      reply.vehicles = SummariesOf(fleet_, models_);
      return reply;
    }
    case FleetCommand::kHistory: return HistoryOf(request);
    case FleetCommand::kModels: return ModelsOf(request);
    case FleetCommand::kDiagnoses: return DiagnosesOf(request);
    case FleetCommand::kRollback: return RollbackOf(request);
    case FleetCommand::kCancel: return CancelOf(request);
    default: return ReplyWith(request, ReplyOutcome::kFailed, "no such command");
  }
}

FleetReply FleetJobs::HistoryOf(const FleetRequest& request) const {
  const std::string& vehicle_id = request.vehicle_ids.front();
  FleetReply reply = ReplyWith(request, ReplyOutcome::kAnswered);
  for (const StoredModel& stored : models_.History(vehicle_id)) {
    reply.models.push_back(SummaryOf(stored.model));
  }
  if (reply.models.empty() && fleet_.Find(vehicle_id) == nullptr) return NotServed(request, fleet_);
  return reply;
}

FleetReply FleetJobs::ModelsOf(const FleetRequest& request) const {
  FleetReply reply = ReplyWith(request, ReplyOutcome::kAnswered);
  reply.later_models = models_.Later(request.vehicle_ids.front(), request.revision, kModelsAtATime);
  return reply;
}

FleetReply FleetJobs::DiagnosesOf(const FleetRequest& request) const {
  FleetReply reply = ReplyWith(request, ReplyOutcome::kAnswered);
  reply.earlier_diagnoses =
      diagnoses_.Earlier(request.vehicle_ids.front(), request.before_unix_s, kDiagnosesAtATime);
  return reply;
}

FleetReply FleetJobs::RollbackOf(const FleetRequest& request) {
  const std::string& vehicle_id = request.vehicle_ids.front();
  if (fleet_.Find(vehicle_id) == nullptr) return NotServed(request, fleet_);
  const auto model = models_.Rollback(vehicle_id, request.revision);
  if (!model) {
    return ReplyWith(request, ReplyOutcome::kFailed,
                     "revision = " + std::to_string(request.revision) + ": a revision of " +
                         vehicle_id + " that is kept; telltale history --vehicle-id " + vehicle_id +
                         " lists them");
  }
  FleetReply reply = ReplyWith(request, ReplyOutcome::kAnswered);
  reply.models.push_back(SummaryOf(*model));
  return reply;
}

FleetReply FleetJobs::CancelOf(const FleetRequest& request) {
  if (const auto found = runs_.find(request.target); found != runs_.end()) {
    RefreshRun& run = *found->second;
    const bool finished = run.finished();
    run.CancelWaiting();
    for (const RefreshedVehicle& vehicle : run.vehicles()) {
      const auto running = running_.find(run.correlation_id() + ' ' + vehicle.vehicle_id);
      if (running == running_.end()) continue;
      identifications_.cancel(running->second);
      RefreshedVehicle cancelled = vehicle;
      cancelled.state = RefreshState::kCancelled;
      run.Update(cancelled);
    }
    if (!finished) spdlog::info("the refresh {} was cancelled", request.target);
    if (!finished && run.finished()) End(run);
    return finished ? ReplyWith(request, ReplyOutcome::kFailed,
                                "refresh '" + request.target + "' has ended already")
                    : ReplyWith(request, ReplyOutcome::kAnswered);
  }
  if (identifications_.cancel(request.target)) return ReplyWith(request, ReplyOutcome::kAnswered);
  return ReplyWith(request, ReplyOutcome::kFailed,
                   "no request '" + request.target + "' waits or runs here");
}

/// It begins, and its client hears of it, once it is on disk.
void FleetJobs::KeepRefresh(const FleetRequest& request, SliceSet slices) {
  if (const auto unavailable = journal_.Unavailable()) {
    FleetReply reply =
        ReplyWith(request, ReplyOutcome::kFailed, *unavailable + "; ask again later");
    reply.slices = slices;
    return replies_.Send(reply);
  }
  if (journal_.Waiting() >= kRequestsThatWait) return TurnAway(request, std::nullopt);
  journal_.Keep(request, [inbox = inbox_, request] {
    {
      const std::lock_guard lock(inbox->mutex);
      inbox->kept.push_back(request);
    }
    inbox->wake.notify_all();
  });
}

void FleetJobs::BeginRefresh(const FleetRequest& request) {
  if (runs_.contains(request.correlation_id)) return;  // it was asked for again in the meantime
  journal_.CountAttempt(request.correlation_id);
  const SliceSet slices = served_();
  const auto vehicle_ids = VehiclesToRefresh(request, fleet_, models_);
  spdlog::info("the refresh {} of {} vehicles begins", request.correlation_id, vehicle_ids.size());
  const auto run =
      runs_
          .emplace(request.correlation_id,
                   std::make_unique<RefreshRun>(request.correlation_id, vehicle_ids, slices))
          .first;
  if (run->second->finished()) return End(*run->second);
  Advance();
}

void FleetJobs::AnswerGivenUp(const FleetRequest& request, const std::string& reason) {
  spdlog::error("the refresh {}: {}", request.correlation_id, reason);
  journal_.Drop(request.correlation_id);
  Reply(ReplyWith(request, ReplyOutcome::kFailed, reason), served_());
}

void FleetJobs::Follow(const FleetRequest& request, SliceSet slices) {
  const auto found = runs_.find(request.target);
  if (found == runs_.end()) {
    return Reply(ReplyWith(request, ReplyOutcome::kFailed,
                           "no refresh '" + request.target + "' is known here"),
                 slices);
  }
  RefreshRun& run = *found->second;
  if (run.finished()) return ReplyTo(run, request.correlation_id);
  run.AddFollower(request.correlation_id);
  Report(run, run.vehicles(), request.correlation_id);
}

/// Keeps the reply for who asks again.
void FleetJobs::Reply(FleetReply reply, SliceSet slices) {
  reply.slices = slices;
  replies_.Send(reply);
  answered_order_.push_back(reply.correlation_id);
  answered_.insert_or_assign(reply.correlation_id, std::move(reply));
  if (answered_order_.size() <= kKeptAnswers) return;
  answered_.erase(answered_order_.front());
  answered_order_.pop_front();
}

void FleetJobs::ReplyTo(const RefreshRun& run, const std::string& correlation_id) {
  FleetReply reply;
  reply.correlation_id = correlation_id;
  reply.outcome = ReplyOutcome::kAnswered;
  reply.refreshed = run.vehicles();
  reply.elapsed_s = run.ElapsedS();
  reply.slices = run.slices();
  replies_.Send(reply);
}

void FleetJobs::Report(const RefreshRun& run, const std::vector<RefreshedVehicle>& vehicles,
                       const std::string& correlation_id) {
  replies_.Send(
      FleetProgress{correlation_id, static_cast<std::uint32_t>(run.vehicles().size()), vehicles});
}

/// Begins what there is room for, and tells what has changed.
void FleetJobs::Advance() {
  for (const auto& [id, run] : runs_) {
    if (run->finished() && std::ranges::find(finished_runs_, id) != finished_runs_.end()) continue;
    while (run->running() < kAtATime && !journal_.Unavailable()) {
      const RefreshedVehicle* next = run->NextWaiting();
      if (next == nullptr) break;
      Begin(*run, std::string(next->vehicle_id));
    }
    const auto changes = run->TakeChanges();
    if (changes.empty()) continue;
    for (const std::string& follower : run->followers()) Report(*run, changes, follower);
    if (run->finished()) End(*run);
  }
  while (finished_runs_.size() > kKeptAnswers) {
    runs_.erase(finished_runs_.front());
    finished_runs_.pop_front();
  }
}

void FleetJobs::Begin(RefreshRun& run, const std::string& vehicle_id) {
  RefreshedVehicle vehicle;
  vehicle.vehicle_id = vehicle_id;
  vehicle.reason = UnchangedReason(vehicle_id);
  if (!vehicle.reason.empty()) {
    vehicle.state = RefreshState::kUnchanged;
    return run.Update(vehicle);
  }
  vehicle.state = RefreshState::kRunning;
  run.Update(vehicle);
  IdentifyRequest request;
  request.correlation_id = NewCorrelationId();
  request.vehicle_id = vehicle_id;
  running_.insert_or_assign(run.correlation_id() + ' ' + vehicle_id, request.correlation_id);
  identifications_.submit(std::move(request), [inbox = inbox_, run_id = run.correlation_id(),
                                               vehicle_id](const IdentifyReply& reply) {
    {
      const std::lock_guard lock(inbox->mutex);
      inbox->outcomes.emplace_back(run_id, OutcomeOfVehicle(vehicle_id, reply));
    }
    inbox->wake.notify_all();
  });
}

void FleetJobs::End(RefreshRun& run) {
  std::map<RefreshState, std::size_t> counts;
  for (const RefreshedVehicle& vehicle : run.vehicles()) ++counts[vehicle.state];
  std::string text;
  for (const auto& [state, count] : counts) {
    text += (text.empty() ? "" : ", ") + std::to_string(count) + ' ' + std::string(Name(state));
  }
  spdlog::info("the refresh {} ended after {:.1f} s: {}", run.correlation_id(), run.ElapsedS(),
               text.empty() ? "no vehicle meets its conditions" : text);
  finished_runs_.push_back(run.correlation_id());
  journal_.Drop(run.correlation_id());
  for (const std::string& follower : run.followers()) ReplyTo(run, follower);
}

/// Empty where the vehicle has sent telemetry since its newest model was made, or has no model.
std::string FleetJobs::UnchangedReason(const std::string& vehicle_id) const {
  VehicleWindow* window = fleet_.Find(vehicle_id);
  const auto latest = models_.Latest(vehicle_id);
  if (window == nullptr || !latest) return "";
  const WindowState state = window->State();
  const std::string revision = "revision " + std::to_string(latest->model.revision);
  if (state.end_s == state.start_s) return "no telemetry is held; " + revision + " stays";
  const double since_s = state.end_s - latest->model.identification.window.end_s;
  // A clock that has gone back began anew.
  if (since_s < -kUnchangedWithinS || since_s > kUnchangedWithinS) return "";
  return "no telemetry since " + revision + " was made";
}

}  // namespace telltale
