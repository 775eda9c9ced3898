#include "telltale/service/monitoring/fleet_view.hpp"

#include <algorithm>

#include <spdlog/fmt/fmt.h>

#include "telltale/idl/codec/json/json_message.hpp"
#include "telltale/service/monitoring/fleet_json.hpp"

namespace telltale {
namespace {

constexpr double kBetweenPointsS = 2.0;
constexpr std::size_t kKeptPoints = 1800;
constexpr std::size_t kKeptJobs = 512;

JobView::State StateOf(ReplyOutcome outcome) {
  switch (outcome) {
    case ReplyOutcome::kPublished: return JobView::State::kPublished;
    case ReplyOutcome::kRefused: return JobView::State::kRefused;
    case ReplyOutcome::kFailed: return JobView::State::kFailed;
    case ReplyOutcome::kAnswered:
    case ReplyOutcome::kUnknown: break;
  }
  return JobView::State::kUnknown;
}

}  // namespace

void FleetView::Take(const Quality& quality, double time_unix_s) {
  const std::lock_guard lock(mutex_);
  if (quality.vehicle_id == kUnattributed) return;
  Vehicle& vehicle = Of(quality.vehicle_id);
  vehicle.quality = {quality, time_unix_s};
  if (!vehicle.past.empty() && time_unix_s < vehicle.past.back().time_unix_s + kBetweenPointsS) {
    return;
  }
  vehicle.past.push_back({time_unix_s, quality.prediction_error, quality.position});
  if (vehicle.past.size() > kKeptPoints) vehicle.past.pop_front();
}

void FleetView::Take(const PublishedDiagnosis& diagnosis) {
  const std::lock_guard lock(mutex_);
  Of(diagnosis.diagnosis.vehicle_id).diagnosis =
      std::make_shared<const PublishedDiagnosis>(diagnosis);
}

void FleetView::Take(const IdentifyProgress& progress) {
  Advance(JobView::Kind::kRefresh, progress);
}

void FleetView::Take(const DiagnoseProgress& progress) {
  Advance(JobView::Kind::kDiagnose, progress);
}

void FleetView::Take(const IdentifyReply& reply) {
  Finish(JobView::Kind::kRefresh, reply, reply.model ? reply.model->revision : 0);
  const std::lock_guard lock(mutex_);
  std::optional<Refusal>& refusal = Of(reply.vehicle_id).refusal;
  if (reply.outcome == ReplyOutcome::kPublished) refusal.reset();
  if (reply.outcome == ReplyOutcome::kRefused && !reply.refusals.empty()) {
    refusal = reply.refusals.front();
  }
}

void FleetView::Take(const DiagnoseReply& reply) {
  Finish(JobView::Kind::kDiagnose, reply, 0);
}

void FleetView::Advance(JobView::Kind kind, const ExchangeProgress& progress) {
  const std::lock_guard lock(mutex_);
  JobView& job = Job(kind, progress.correlation_id, progress.vehicle_id);
  if (job.state > JobView::State::kRunning) return;
  job.state = JobView::State::kRunning;
  job.stage = progress.stage;
  job.fraction = progress.fraction;
  events_.Add("job", PrintJsonLine(ToProto(job)));
}

void FleetView::Finish(JobView::Kind kind, const ExchangeReply& reply, std::uint64_t revision) {
  const std::lock_guard lock(mutex_);
  JobView& job = Job(kind, reply.correlation_id, reply.vehicle_id);
  // A reply that is sent again is of a request that has ended already.
  if (job.state <= JobView::State::kRunning) ++finished_[{kind, StateOf(reply.outcome)}];
  job.state = StateOf(reply.outcome);
  job.fraction = 1.0;
  job.message = reply.message;
  job.refusals = reply.refusals;
  job.revision = revision;
  events_.Add("job", PrintJsonLine(ToProto(job)));
}

/// The job of this id, begun where it is not known; the caller holds mutex_.
JobView& FleetView::Job(JobView::Kind kind, const std::string& id, const std::string& vehicle_id) {
  const auto known = std::ranges::find(jobs_, id, &JobView::id);
  if (known != jobs_.end()) return *known;
  if (jobs_.size() == kKeptJobs) jobs_.pop_front();
  JobView& job = jobs_.emplace_back();
  job.id = id;
  job.vehicle_id = vehicle_id;
  job.kind = kind;
  return job;
}

std::optional<Refusal> FleetView::LastRefusalOf(std::string_view vehicle_id) const {
  const std::lock_guard lock(mutex_);
  const auto vehicle = vehicles_.find(vehicle_id);
  return vehicle == vehicles_.end() ? std::nullopt : vehicle->second.refusal;
}

void FleetView::TakeDrift(const std::string& vehicle_id, std::optional<double> onset_s) {
  const std::lock_guard lock(mutex_);
  Of(vehicle_id).drift_onset_s = onset_s;
}

std::optional<double> FleetView::DriftOnsetOf(std::string_view vehicle_id) const {
  const std::lock_guard lock(mutex_);
  const auto vehicle = vehicles_.find(vehicle_id);
  return vehicle == vehicles_.end() ? std::nullopt : vehicle->second.drift_onset_s;
}

void FleetView::Advise(const std::string& vehicle_id, std::uint64_t revision,
                       const std::string& advice) {
  const std::lock_guard lock(mutex_);
  Vehicle& vehicle = Of(vehicle_id);
  vehicle.advice = advice;
  vehicle.advised_revision = revision;
}

std::string FleetView::AdviceOf(std::string_view vehicle_id, std::uint64_t revision) const {
  const std::lock_guard lock(mutex_);
  const auto vehicle = vehicles_.find(vehicle_id);
  const bool known = vehicle != vehicles_.end() && vehicle->second.advised_revision == revision;
  return known ? vehicle->second.advice : "";
}

void FleetView::TakeSource(const std::string& name, const std::optional<std::string>& fault) {
  const std::lock_guard lock(mutex_);
  if (fault) {
    source_faults_[name] = *fault;
  } else {
    source_faults_.erase(name);
  }
}

std::vector<std::string> FleetView::SourceFaults() const {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> faults;
  for (const auto& [name, fault] : source_faults_)
    faults.push_back(fmt::format("{}: {}", name, fault));
  return faults;
}

std::shared_ptr<const PublishedDiagnosis> FleetView::LastDiagnosisOf(
    std::string_view vehicle_id) const {
  const std::lock_guard lock(mutex_);
  const auto vehicle = vehicles_.find(vehicle_id);
  return vehicle == vehicles_.end() ? nullptr : vehicle->second.diagnosis;
}

std::optional<TimedQuality> FleetView::QualityOf(std::string_view vehicle_id) const {
  const std::lock_guard lock(mutex_);
  const auto vehicle = vehicles_.find(vehicle_id);
  return vehicle == vehicles_.end() ? std::nullopt : vehicle->second.quality;
}

std::vector<Quality> FleetView::Qualities() const {
  const std::lock_guard lock(mutex_);
  std::vector<Quality> all;
  for (const auto& [id, vehicle] : vehicles_) {
    if (vehicle.quality) all.push_back(vehicle.quality->quality);
  }
  return all;
}

void FleetView::EndRound(double began_unix_s, double time_unix_s,
                         std::vector<RejectEntry> unattributed) {
  const std::lock_guard lock(mutex_);
  for (auto& [id, vehicle] : vehicles_) {
    if (!vehicle.quality || vehicle.quality->time_unix_s >= began_unix_s) continue;
    vehicle.quality.reset();
    vehicle.past.clear();
  }
  last_round_unix_s_ = time_unix_s;
  unattributed_ = std::move(unattributed);
}

double FleetView::LastRoundUnixS() const {
  const std::lock_guard lock(mutex_);
  return last_round_unix_s_;
}

std::vector<RejectEntry> FleetView::Unattributed() const {
  const std::lock_guard lock(mutex_);
  return unattributed_;
}

JobView FleetView::Begin(JobView::Kind kind, const std::string& id, const std::string& vehicle_id) {
  const std::lock_guard lock(mutex_);
  JobView& job = Job(kind, id, vehicle_id);
  job.state = JobView::State::kRunning;
  job.stage = "queued";
  return job;
}

JobCounts FleetView::Finished() const {
  const std::lock_guard lock(mutex_);
  return finished_;
}

std::vector<PastPoint> FleetView::PastOf(std::string_view vehicle_id) const {
  const std::lock_guard lock(mutex_);
  const auto vehicle = vehicles_.find(vehicle_id);
  if (vehicle == vehicles_.end()) return {};
  return {vehicle->second.past.begin(), vehicle->second.past.end()};
}

std::vector<JobView> FleetView::Jobs() const {
  const std::lock_guard lock(mutex_);
  return {jobs_.rbegin(), jobs_.rend()};
}

std::optional<JobView> FleetView::JobOf(std::string_view id) const {
  const std::lock_guard lock(mutex_);
  const auto job = std::ranges::find(jobs_, id, &JobView::id);
  return job == jobs_.end() ? std::nullopt : std::optional(*job);
}

}  // namespace telltale
