#include "telltale/service/upkeep/upkeep.hpp"

#include <chrono>
#include <exception>
#include <utility>

#include <spdlog/spdlog.h>

#include "telltale/client/fleet/unix_now.hpp"

namespace telltale {
namespace {

constexpr std::chrono::seconds kLookPeriod{1};

}  // namespace

Upkeep::Upkeep(const UpkeepSettings& settings, const Fleet& fleet, const PublishedModels& models,
               FleetView& view, Orders orders)
    : refresh_(settings.refresh),
      fleet_(fleet),
      models_(models),
      view_(view),
      orders_(std::move(orders)),
      rules_(settings, UnixNow()),
      thread_([this] { Run(); }) {}

Upkeep::~Upkeep() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

void Upkeep::Run() {
  std::unique_lock lock(mutex_);
  while (!wake_.wait_for(lock, kLookPeriod, [this] { return stopping_; })) {
    lock.unlock();
    try {
      Look();
    } catch (const std::exception& error) {
      spdlog::error("upkeep: {}", error.what());
    }
    lock.lock();
  }
}

void Upkeep::Look() {
  std::vector<std::string> due;
  for (const auto& [vehicle_id, window] : fleet_.windows()) {
    const UpkeepFacts facts = FactsOf(vehicle_id, *window);
    const UpkeepStep step = rules_.Consider(vehicle_id, facts, UnixNow());
    if (step.diagnose) {
      spdlog::info("{}: its model drifts; a diagnosis begins", vehicle_id);
      orders_.diagnose(vehicle_id);
    }
    if (step.refresh.empty()) continue;
    if (refresh_ == RefreshMode::kAdvise) {
      Advise(vehicle_id, facts.revision, step.refresh);
    } else {
      spdlog::info("{}: a refresh is due: {}", vehicle_id, step.refresh);
      due.push_back(vehicle_id);
    }
  }
  if (!due.empty()) orders_.refresh(due);
}

UpkeepFacts Upkeep::FactsOf(const std::string& vehicle_id, VehicleWindow& window) const {
  UpkeepFacts facts;
  const WindowState state = window.State();
  facts.has_telemetry = state.end_s > state.start_s;
  if (const auto latest = models_.Latest(vehicle_id)) {
    facts.revision = latest->model.revision;
    facts.published_unix_s = latest->model.published_unix_s;
  }
  const auto timed = view_.QualityOf(vehicle_id);
  // The report may be about the model before.
  if (timed && timed->quality.model_revision == facts.revision) {
    facts.drift_since_unix_s = timed->quality.drift_since_unix_s;
    const auto onset_s = view_.DriftOnsetOf(vehicle_id);
    if (onset_s) facts.drift_lasts_s = state.end_s - *onset_s;
  }
  if (const auto diagnosis = view_.LastDiagnosisOf(vehicle_id)) {
    facts.diagnosed_revision = diagnosis->model_revision;
  }
  return facts;
}

void Upkeep::Advise(const std::string& vehicle_id, std::uint64_t revision,
                    const std::string& reason) {
  const std::string advice =
      "a refresh is due: " + reason + "; telltale refresh --vehicle-id " + vehicle_id;
  spdlog::warn("{}: {}", vehicle_id, advice);
  view_.Advise(vehicle_id, revision, advice);
}

}  // namespace telltale
