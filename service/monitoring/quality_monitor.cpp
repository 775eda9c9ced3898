#include "telltale/service/monitoring/quality_monitor.hpp"

#include <exception>
#include <utility>

#include <spdlog/spdlog.h>

#include "telltale/core/data/recording_parts.hpp"
#include "telltale/idl/codec/wire/quality.hpp"
#include "telltale/service/monitoring/prediction_error.hpp"
#include "telltale/service/unix_now.hpp"

namespace telltale {
namespace {

constexpr double kEvaluatedSpanS = 60.0;
constexpr double kNewDataS = 5.0;     // one more free-run window has to fit before evaluating again
constexpr double kDriftWeight = 0.1;  // of the newest change, so that drift remembers about ten

double Rate(Channel channel, const WindowState& now, const WindowState& before, double elapsed_s) {
  const auto i = static_cast<std::size_t>(channel);
  return static_cast<double>(now.arrived[i] - before.arrived[i]) / elapsed_s;
}

/// Monitoring goes on after a failure, which the log names.
template <class Work>
void LoggingFailure(Work work) {
  try {
    work();
  } catch (const std::exception& error) {
    spdlog::error("monitoring: {}", error.what());
  }
}

void WriteCounts(const WindowState& state, Quality& quality) {
  quality.window_s = state.end_s - state.start_s;
  quality.window_fill = state.fill;
  quality.lost = state.lost;
  quality.accepted = state.accepted;
  quality.rejected = RejectEntries(state.rejected);
}

}  // namespace

QualityMonitor::QualityMonitor(const Participant& participant, Fleet& fleet,
                               PublishedModels& models, double period_s)
    : fleet_(fleet), models_(models), period_(period_s), writer_(participant), thread_([this] {
        Run();
      }) {}

QualityMonitor::~QualityMonitor() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

void QualityMonitor::PublishReceipt(VehicleWindow& window) {
  {
    const std::lock_guard lock(mutex_);
    receipts_due_.insert(&window);
  }
  wake_.notify_all();
}

void QualityMonitor::Run() {
  auto last = Clock::now();
  const auto period = std::chrono::ceil<Clock::duration>(period_);
  while (WaitUntil(last + period)) {
    const auto now = Clock::now();
    LoggingFailure([&] {
      PublishAll(std::chrono::duration<double>(now - last).count());
      models_.PublishHeldUp();
    });
    last = now;
  }
}

bool QualityMonitor::WaitUntil(Clock::time_point deadline) {
  std::unique_lock lock(mutex_);
  while (!stopping_ && Clock::now() < deadline) {
    wake_.wait_until(lock, deadline, [this] { return stopping_ || !receipts_due_.empty(); });
    if (stopping_ || receipts_due_.empty()) continue;
    lock.unlock();
    LoggingFailure([this] { PublishReceipts(); });
    lock.lock();
  }
  return !stopping_;
}

void QualityMonitor::PublishReceipts() {
  std::set<VehicleWindow*> due;
  {
    const std::lock_guard lock(mutex_);
    std::swap(due, receipts_due_);
  }
  for (VehicleWindow* window : due) {
    Memory& memory = memories_[window->vehicle().vehicle_id];
    WriteCounts(window->State(), memory.quality);
    memory.quality.vehicle_id = window->vehicle().vehicle_id;
    memory.quality.sequence_number = ++memory.published;
    writer_.Write(Encode(memory.quality));
  }
}

void QualityMonitor::PublishAll(double elapsed_s) {
  for (const auto& [vehicle_id, window] : fleet_.windows()) {
    Memory& memory = memories_[vehicle_id];
    memory.quality = Assess(*window, memory, elapsed_s);
    writer_.Write(Encode(memory.quality));
  }
  Quality unattributed;
  unattributed.vehicle_id = kUnattributed;
  unattributed.sequence_number = ++unattributed_published_;
  unattributed.rejected = fleet_.Unattributed();
  writer_.Write(Encode(unattributed));
}

Quality QualityMonitor::Assess(VehicleWindow& window, Memory& memory, double elapsed_s) {
  const WindowState state = window.State();
  Quality quality;
  quality.vehicle_id = window.vehicle().vehicle_id;
  quality.sequence_number = ++memory.published;
  WriteCounts(state, quality);
  quality.gnss_rate_hz = Rate(Channel::kGnss, state, memory.window, elapsed_s);
  quality.heading_rate_hz = Rate(Channel::kHeading, state, memory.window, elapsed_s);
  quality.thrusters_rate_hz = Rate(Channel::kThrusters, state, memory.window, elapsed_s);
  memory.window = state;
  Follow(window, state, memory);
  quality.indicative = memory.indicative;
  quality.indicative_rows = memory.live.rows();
  if (const auto latest = models_.Latest(quality.vehicle_id)) {
    Evaluate(window, state, *latest, memory);
    quality.model_revision = latest->model.revision;
    quality.model_age_s = UnixNow() - latest->model.published_unix_s;
    quality.prediction_error = memory.prediction_error.value_or(0.0);
    quality.drift = memory.drift;
    quality.proposal = Propose(quality, memory);
  }
  return quality;
}

void QualityMonitor::Follow(VehicleWindow& window, const WindowState& state, Memory& memory) {
  if (state.accepted == 0 || !memory.live.IsDue(state.end_s)) return;
  memory.live.Update(window.Snapshot(), window.vehicle());
  memory.indicative = memory.live.Estimates();
}

void QualityMonitor::Evaluate(VehicleWindow& window, const WindowState& state,
                              const StoredModel& model, Memory& memory) {
  const std::uint64_t revision = model.model.revision;
  if (!model.reference_error) return;
  if (std::exchange(memory.evaluated_revision, revision) != revision) {
    memory.prediction_error.reset();
    memory.drift = 0.0;
    memory.drift_detector = DriftDetector();
  } else if (state.end_s < memory.evaluated_to_s + kNewDataS) {
    return;
  }
  memory.evaluated_to_s = state.end_s;
  const auto error = MeasureFreeRunError(Latest(window.Snapshot(), kEvaluatedSpanS),
                                         window.vehicle(), model.model.identification);
  if (!error) return;
  const double relative = RelativeError(*error, *model.reference_error);
  if (memory.prediction_error) {
    memory.drift += kDriftWeight * (relative - *memory.prediction_error - memory.drift);
  }
  memory.prediction_error = relative;
  memory.drift_detector.Add(relative);
}

std::string QualityMonitor::Propose(const Quality& quality, Memory& memory) {
  const bool fires = memory.drift_detector.Fires();
  std::string proposal;
  if (fires) {
    proposal = fmt::format(
        "revision {} predicts {:.1f} times worse than when it was made; "
        "telltale diagnose --vehicle-id {} asks why",
        *quality.model_revision, quality.prediction_error, quality.vehicle_id);
  }
  if (fires && !std::exchange(memory.proposed, fires)) {
    spdlog::warn("{}: {}", quality.vehicle_id, proposal);
  }
  memory.proposed = fires;
  return proposal;
}

}  // namespace telltale
