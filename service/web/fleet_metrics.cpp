#include "telltale/service/web/fleet_metrics.hpp"

#include <array>
#include <functional>
#include <string>
#include <utility>

#include "telltale/core/base/version.hpp"
#include "telltale/service/web/process_usage.hpp"

namespace telltale {
namespace {

using prometheus::ClientMetric;
using prometheus::MetricFamily;
using prometheus::MetricType;
using Labels = std::vector<ClientMetric::Label>;

/// One family, filled value by value.
class MetricValues {
 public:
  MetricValues(MetricType type, std::string name, std::string help)
      : family_{std::move(name), std::move(help), type, {}} {}

  /// Of a family that is a summary: how many, and their sum.
  void Add(Labels labels, std::uint64_t count, double sum) {
    ClientMetric& metric = family_.metric.emplace_back();
    metric.label = std::move(labels);
    metric.summary.sample_count = count;
    metric.summary.sample_sum = sum;
  }

  void Add(Labels labels, double value) {
    ClientMetric& metric = family_.metric.emplace_back();
    metric.label = std::move(labels);
    if (family_.type == MetricType::Counter) {
      metric.counter.value = value;
    } else {
      metric.gauge.value = value;
    }
  }

  MetricFamily Take() && { return std::move(family_); }

 private:
  MetricFamily family_;
};

/// A number of each vehicle; nothing of those that have none.
struct VehicleNumber {
  const char* name;
  const char* help;
  MetricType type;
  std::function<std::optional<double>(const Quality&)> of;
};

std::optional<double> OfModel(const Quality& quality, double value) {
  return quality.model_revision ? std::optional(value) : std::nullopt;
}

std::vector<VehicleNumber> TelemetryNumbers() {
  using enum MetricType;
  return {
      {"telltale_vehicle_window_fill_ratio", "Share of the window that telemetry fills.", Gauge,
       [](const Quality& q) { return q.window_fill; }},
      {"telltale_vehicle_silence_seconds", "Time since the newest sample arrived.", Gauge,
       [](const Quality& q) { return q.silent_s; }},
      {"telltale_vehicle_loss_ratio", "Share of the samples sent in the last minute that are lost.",
       Gauge, [](const Quality& q) { return q.loss_share; }},
      {"telltale_vehicle_reject_ratio",
       "Share of the samples of the last minute that are rejected.", Gauge,
       [](const Quality& q) { return q.reject_share; }},
      {"telltale_vehicle_shed_ratio",
       "Share of the samples of the last minute that the daemon did not take in.", Gauge,
       [](const Quality& q) { return q.shed_share; }},
      {"telltale_vehicle_window_bytes", "Memory of the samples that the window holds.", Gauge,
       [](const Quality& q) { return static_cast<double>(q.window_bytes); }},
      {"telltale_vehicle_samples_accepted_total", "Samples that reached the window.", Counter,
       [](const Quality& q) { return static_cast<double>(q.accepted); }},
      {"telltale_vehicle_samples_lost_total", "Samples missing by their sequence numbers.", Counter,
       [](const Quality& q) { return static_cast<double>(q.lost); }}};
}

std::vector<VehicleNumber> ModelNumbers() {
  using enum MetricType;
  return {
      {"telltale_vehicle_model_revision", "Revision of the published model.", Gauge,
       [](const Quality& q) {
         return OfModel(q, static_cast<double>(q.model_revision.value_or(0)));
       }},
      {"telltale_vehicle_model_age_seconds", "Time since the model was published.", Gauge,
       [](const Quality& q) { return OfModel(q, q.model_age_s); }},
      {"telltale_vehicle_prediction_error_ratio",
       "Free-run error of the last minute in units of that when the model was made.", Gauge,
       [](const Quality& q) {
         return q.prediction_error > 0.0 ? OfModel(q, q.prediction_error) : std::nullopt;
       }},
      {"telltale_vehicle_drift_onset_timestamp_seconds",
       "When the drift of the model began; 0: there is no drift.", Gauge,
       [](const Quality& q) { return OfModel(q, q.drift_since_unix_s); }},
      {"telltale_vehicle_model_coefficients", "Coefficients of the model.", Gauge,
       [](const Quality& q) { return OfModel(q, q.coefficients); }},
      {"telltale_vehicle_model_coefficients_identified",
       "Coefficients of the model that the data determine.", Gauge,
       [](const Quality& q) { return OfModel(q, q.identified); }},
      {"telltale_vehicle_model_relative_half_width_ratio",
       "Median half width of the bounds in units of the estimates.", Gauge, [](const Quality& q) {
         return q.relative_half_width > 0.0 ? OfModel(q, q.relative_half_width) : std::nullopt;
       }}};
}

void AddNumbers(const std::vector<Quality>& fleet, const std::vector<VehicleNumber>& numbers,
                std::vector<MetricFamily>& families) {
  for (const VehicleNumber& number : numbers) {
    MetricValues values(number.type, number.name, number.help);
    for (const Quality& quality : fleet) {
      if (const auto value = number.of(quality)) {
        values.Add({{"vehicle_id", quality.vehicle_id}}, *value);
      }
    }
    families.push_back(std::move(values).Take());
  }
}

MetricFamily VerdictStates(const std::vector<Quality>& fleet) {
  MetricValues values(MetricType::Gauge, "telltale_vehicle_verdict",
                      "1 for the verdict that the vehicle has, 0 for the others.");
  for (const Quality& quality : fleet) {
    for (const QualityVerdict verdict : kQualityVerdicts) {
      values.Add({{"vehicle_id", quality.vehicle_id}, {"verdict", std::string(Name(verdict))}},
                 quality.verdict == verdict ? 1.0 : 0.0);
    }
  }
  return std::move(values).Take();
}

MetricFamily ActiveReasons(const std::vector<Quality>& fleet) {
  MetricValues values(MetricType::Gauge, "telltale_vehicle_reason",
                      "1 for each reason why the vehicle is not OK.");
  for (const Quality& quality : fleet) {
    for (const QualityReason& reason : quality.reasons) {
      values.Add({{"vehicle_id", quality.vehicle_id},
                  {"code", reason.code},
                  {"verdict", std::string(Name(reason.verdict))}},
                 1.0);
    }
  }
  return std::move(values).Take();
}

MetricFamily SampleRates(const std::vector<Quality>& fleet) {
  MetricValues values(MetricType::Gauge, "telltale_vehicle_sample_rate_hertz",
                      "Samples a second in the last period.");
  for (const Quality& quality : fleet) {
    const std::array<std::pair<const char*, double>, 3> rates = {
        {{"gnss", quality.gnss_rate_hz},
         {"heading", quality.heading_rate_hz},
         {"thrusters", quality.thrusters_rate_hz}}};
    for (const auto& [channel, rate] : rates) {
      values.Add({{"vehicle_id", quality.vehicle_id}, {"channel", channel}}, rate);
    }
  }
  return std::move(values).Take();
}

MetricFamily ModelVerdicts(const std::vector<Quality>& fleet) {
  MetricValues values(MetricType::Gauge, "telltale_vehicle_model_verdict",
                      "1 for the verdict that the model got when it was made, 0 for the others.");
  for (const Quality& quality : fleet) {
    if (quality.model_verdict.verdict == PromotionVerdict::kUnknown) continue;
    for (const auto verdict :
         {PromotionVerdict::kOk, PromotionVerdict::kWarn, PromotionVerdict::kError}) {
      values.Add({{"vehicle_id", quality.vehicle_id}, {"verdict", std::string(Name(verdict))}},
                 quality.model_verdict.verdict == verdict ? 1.0 : 0.0);
    }
  }
  return std::move(values).Take();
}

MetricFamily Delays(const std::vector<Quality>& fleet) {
  MetricValues values(MetricType::Gauge, "telltale_vehicle_delay_seconds",
                      "How far the stamps of a channel lie behind those of the headings.");
  for (const Quality& quality : fleet) {
    for (const ChannelDelay& delay : quality.delays) {
      values.Add(
          {{"vehicle_id", quality.vehicle_id}, {"channel", std::string(Name(delay.channel))}},
          delay.estimate_s);
    }
  }
  return std::move(values).Take();
}

MetricFamily RejectedSamples(const std::vector<Quality>& fleet) {
  MetricValues values(MetricType::Counter, "telltale_vehicle_samples_rejected_total",
                      "Samples that were rejected.");
  for (const Quality& quality : fleet) {
    for (const RejectEntry& entry : quality.rejected) {
      values.Add({{"vehicle_id", quality.vehicle_id},
                  {"channel", entry.channel},
                  {"reason", entry.reason}},
                 static_cast<double>(entry.count));
    }
  }
  return std::move(values).Take();
}

MetricFamily ShedSamples(const std::vector<Quality>& fleet) {
  MetricValues values(MetricType::Counter, "telltale_vehicle_samples_shed_total",
                      "Samples that arrived and were not taken in, since too many came.");
  for (const Quality& quality : fleet) {
    for (const Channel channel : kChannels) {
      values.Add({{"vehicle_id", quality.vehicle_id}, {"channel", std::string(Name(channel))}},
                 static_cast<double>(quality.shed[static_cast<std::size_t>(channel)]));
    }
  }
  return std::move(values).Take();
}

MetricFamily UnattributedSamples(const FleetView& view) {
  MetricValues values(MetricType::Counter, "telltale_unattributed_samples_total",
                      "Samples that name no vehicle of this daemon.");
  for (const RejectEntry& entry : view.Unattributed()) {
    values.Add({{"channel", entry.channel}, {"reason", entry.reason}},
               static_cast<double>(entry.count));
  }
  return std::move(values).Take();
}

const char* KindName(JobView::Kind kind) {
  return kind == JobView::Kind::kDiagnose ? "diagnose" : "refresh";
}

const char* OutcomeName(JobView::State state) {
  switch (state) {
    case JobView::State::kPublished: return "published";
    case JobView::State::kRefused: return "refused";
    default: return "failed";
  }
}

/// Every kind and outcome, since a rate needs the zero from which a counter starts.
MetricFamily FinishedJobs(const FleetView& view) {
  MetricValues values(MetricType::Counter, "telltale_jobs_total",
                      "Requests that ended since the daemon started.");
  const JobCounts counts = view.Finished();
  for (const auto kind : {JobView::Kind::kRefresh, JobView::Kind::kDiagnose}) {
    for (const auto state :
         {JobView::State::kPublished, JobView::State::kRefused, JobView::State::kFailed}) {
      const auto count = counts.find({kind, state});
      values.Add({{"kind", KindName(kind)}, {"outcome", OutcomeName(state)}},
                 count == counts.end() ? 0.0 : static_cast<double>(count->second));
    }
  }
  return std::move(values).Take();
}

MetricFamily UnfinishedJobs(const FleetView& view) {
  MetricValues values(MetricType::Gauge, "telltale_jobs_unfinished",
                      "Requests that wait or are worked on.");
  std::map<JobView::Kind, double> counts = {{JobView::Kind::kRefresh, 0.0},
                                            {JobView::Kind::kDiagnose, 0.0}};
  for (const JobView& job : view.Jobs()) {
    if (job.state <= JobView::State::kRunning) ++counts[job.kind];
  }
  for (const auto& [kind, count] : counts) values.Add({{"kind", KindName(kind)}}, count);
  return std::move(values).Take();
}

/// A number of each queue.
MetricFamily QueueNumbers(const std::vector<QueueActivity>& queues, MetricType type,
                          const char* name, const char* help, auto QueueActivity::*number) {
  MetricValues values(type, name, help);
  for (const QueueActivity& queue : queues) {
    values.Add({{"queue", queue.queue}}, static_cast<double>(queue.*number));
  }
  return std::move(values).Take();
}

/// Of what is offered to workers.
MetricFamily OfferedJobs(const std::vector<HeavyActivity>& heavy_jobs) {
  MetricValues values(MetricType::Gauge, "telltale_worker_jobs",
                      "Jobs that are offered to workers.");
  for (const HeavyActivity& jobs : heavy_jobs) {
    values.Add({{"queue", jobs.queue}, {"state", "waiting"}}, static_cast<double>(jobs.waiting));
    values.Add({{"queue", jobs.queue}, {"state", "taken"}}, static_cast<double>(jobs.taken));
  }
  return std::move(values).Take();
}

MetricFamily EndedHeavyJobs(const std::vector<HeavyActivity>& heavy_jobs) {
  MetricValues values(MetricType::Counter, "telltale_worker_jobs_total",
                      "Jobs for workers that ended since the daemon started.");
  for (const HeavyActivity& jobs : heavy_jobs) {
    const std::array<std::pair<const char*, std::uint64_t>, 3> counts = {
        {{"answered", jobs.answered},
         {"given_up", jobs.given_up},
         {"computed_here", jobs.computed_here}}};
    for (const auto& [outcome, count] : counts) {
      values.Add({{"queue", jobs.queue}, {"outcome", outcome}}, static_cast<double>(count));
    }
  }
  return std::move(values).Take();
}

MetricFamily StoreWrites(const std::vector<StoreActivity>& stores) {
  MetricValues values(MetricType::Summary, "telltale_store_write_seconds",
                      "Writes to a database, and the time that they took.");
  for (const auto& [store, written] : stores) {
    values.Add({{"store", store}}, written.writes, written.duration_s);
  }
  return std::move(values).Take();
}

MetricFamily RemovedRows(const RetentionActivity& retention) {
  using enum RemovedKind;
  using enum RemovalReason;
  MetricValues values(MetricType::Counter, "telltale_store_rows_removed_total",
                      "Rows that retention has removed from the store.");
  for (const auto kind : {kEarlierModel, kEarlierDiagnosis, kWindowChunk}) {
    for (const auto reason : {kCount, kAge, kSize}) {
      const auto rows = retention.removed.find({kind, reason});
      values.Add({{"kind", std::string(Name(kind))}, {"reason", std::string(Name(reason))}},
                 rows == retention.removed.end() ? 0.0 : static_cast<double>(rows->second));
    }
  }
  return std::move(values).Take();
}

MetricFamily StoreBytes(const RetentionPass& pass) {
  MetricValues values(MetricType::Gauge, "telltale_store_bytes",
                      "What the rows of a database took at the last check.");
  for (const auto& [store, bytes] : pass.used_bytes) {
    values.Add({{"store", store}}, static_cast<double>(bytes));
  }
  return std::move(values).Take();
}

MetricFamily ReceivedSamples(const DaemonActivity& activity) {
  MetricValues values(MetricType::Counter, "telltale_received_samples_total",
                      "Samples of telemetry taken from the bus.");
  for (const Channel channel : kChannels) {
    const auto place = static_cast<std::size_t>(channel);
    values.Add({{"channel", std::string(Name(channel))}},
               static_cast<double>(activity.received[place]));
  }
  return std::move(values).Take();
}

MetricFamily Matches(const std::vector<TopicConnections>& matches) {
  MetricValues values(MetricType::Gauge, "telltale_dds_matches",
                      "Other ends of a topic that the daemon is connected to.");
  for (const auto& [topic, count] : matches) values.Add({{"topic", topic}}, count);
  return std::move(values).Take();
}

MetricFamily Single(MetricType type, const char* name, const char* help, double value,
                    const Labels& labels = {}) {
  MetricValues values(type, name, help);
  values.Add(labels, value);
  return std::move(values).Take();
}

void AddRetention(const RetentionActivity& retention, std::vector<MetricFamily>& families) {
  families.push_back(RemovedRows(retention));
  families.push_back(StoreBytes(retention.last));
  if (retention.limit_bytes == 0) return;
  families.push_back(Single(MetricType::Gauge, "telltale_store_limit_bytes",
                            "What all databases may take.",
                            static_cast<double>(retention.limit_bytes)));
  families.push_back(Single(MetricType::Gauge, "telltale_store_over_limit",
                            "1: they take more, and nothing more may be removed; 0: they do not.",
                            retention.last.over_limit ? 1.0 : 0.0));
}

void AddWindows(const WindowActivity& windows, std::vector<MetricFamily>& families) {
  families.push_back(Single(MetricType::Gauge, "telltale_windows_unloaded",
                            "Windows of silent vehicles that the store alone holds.",
                            static_cast<double>(windows.unloaded)));
  families.push_back(Single(MetricType::Gauge, "telltale_window_samples_unsaved",
                            "Samples in windows that wait to be saved.",
                            static_cast<double>(windows.samples.unsaved)));
  families.push_back(Single(MetricType::Counter, "telltale_window_samples_dropped_total",
                            "Samples that went before they were saved.",
                            static_cast<double>(windows.samples.dropped)));
}

void AddActivity(const DaemonActivity& activity, std::vector<MetricFamily>& families) {
  using enum MetricType;
  const auto add = [&](auto... description) {
    families.push_back(QueueNumbers(activity.queues, description...));
  };
  add(Gauge, "telltale_queue_requests_waiting", "Requests that no worker has begun.",
      &QueueActivity::waiting);
  add(Gauge, "telltale_queue_requests_running", "Requests that are worked on.",
      &QueueActivity::running);
  add(Gauge, "telltale_queue_workers", "Threads that work on the requests of a queue.",
      &QueueActivity::workers);
  add(Counter, "telltale_queue_requests_shed_total",
      "Requests that found the queue, or the part that one client may use, full.",
      &QueueActivity::shed);
  families.push_back(OfferedJobs(activity.heavy_jobs));
  families.push_back(EndedHeavyJobs(activity.heavy_jobs));
  families.push_back(StoreWrites(activity.stores));
  AddRetention(activity.retention, families);
  AddWindows(activity.windows, families);
  families.push_back(Single(Gauge, "telltale_requests_unwritten",
                            "Requests, and answers to kept requests, that wait to be written.",
                            static_cast<double>(activity.unwritten_requests)));
  families.push_back(ReceivedSamples(activity));
  families.push_back(Matches(activity.matches));
}

void AddDaemon(FleetView& view, std::size_t vehicles, std::vector<MetricFamily>& families) {
  using enum MetricType;
  families.push_back(UnattributedSamples(view));
  families.push_back(FinishedJobs(view));
  families.push_back(UnfinishedJobs(view));
  families.push_back(Single(Gauge, "telltale_vehicles", "Vehicles that the daemon serves.",
                            static_cast<double>(vehicles)));
  families.push_back(
      Single(Gauge, "telltale_event_streams", "Open streams of events.", view.events().readers()));
  families.push_back(Single(Gauge, "telltale_build_info", "The version of the daemon.", 1.0,
                            {{"version", std::string(Version())}}));
  const ProcessUsage usage = ReadProcessUsage();
  families.push_back(
      Single(Counter, "process_cpu_seconds_total", "CPU time of the daemon.", usage.cpu_s));
  families.push_back(Single(Gauge, "process_resident_memory_bytes", "Resident memory.",
                            static_cast<double>(usage.resident_bytes)));
  families.push_back(Single(Gauge, "process_open_fds", "Open file descriptors.",
                            static_cast<double>(usage.open_descriptors)));
}

}  // namespace

std::vector<prometheus::MetricFamily> FleetMetrics::Collect() const {
  const std::vector<Quality> fleet = view_.Qualities();
  std::vector<MetricFamily> families = {
      VerdictStates(fleet), ActiveReasons(fleet), SampleRates(fleet), RejectedSamples(fleet),
      ShedSamples(fleet),   ModelVerdicts(fleet), Delays(fleet)};
  AddNumbers(fleet, TelemetryNumbers(), families);
  AddNumbers(fleet, ModelNumbers(), families);
  AddDaemon(view_, fleet.size(), families);
  families.push_back(Single(MetricType::Gauge, "telltale_serving",
                            "1: the daemon serves; 0: it stands by for another.",
                            serves_() ? 1.0 : 0.0));
  AddActivity(activity_(), families);
  std::erase_if(families, [](const MetricFamily& family) { return family.metric.empty(); });
  return families;
}

}  // namespace telltale
