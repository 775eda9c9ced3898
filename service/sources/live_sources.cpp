#include "telltale/service/sources/live_sources.hpp"

#include <chrono>
#include <exception>
#include <utility>

#include <spdlog/spdlog.h>

#include "telltale/service/sources/source_of_settings.hpp"

namespace telltale {
namespace {

constexpr auto kRetry = std::chrono::seconds(5);

}  // namespace

LiveSources::LiveSources(const Participant& participant, const std::vector<SourceSettings>& sources,
                         FleetView& view) {
  for (const SourceSettings& settings : sources) {
    runners_.emplace_back(participant, settings, view);
  }
}

LiveSources::~LiveSources() {
  for (Runner& runner : runners_) runner.Stop();
}

LiveSources::Runner::Runner(const Participant& participant, SourceSettings settings,
                            FleetView& view)
    : participant_(participant),
      settings_(std::move(settings)),
      name_(SourceName(settings_)),
      view_(view),
      thread_([this] { Run(); }) {}

void LiveSources::Runner::Stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    if (source_) source_->Stop();
  }
  wake_.notify_all();
}

void LiveSources::Runner::Run() {
  for (;;) {
    try {
      RunOnce();
    } catch (const std::exception& error) {
      Note(error.what());
    }
    std::unique_lock lock(mutex_);
    source_.reset();
    if (wake_.wait_for(lock, kRetry, [this] { return stopping_; })) return;
  }
}

void LiveSources::Runner::RunOnce() {
  auto source = MakeSource(settings_, participant_, [this](const std::string& what) {
    spdlog::info("source {}: {}", name_, what);
  });
  LiveSource& running = *source;
  {
    const std::lock_guard lock(mutex_);
    if (stopping_) return;
    source_ = std::move(source);
  }
  spdlog::info("source {} is open", name_);
  noted_.clear();
  view_.TakeSource(name_, std::nullopt);
  running.Run([&] { view_.TakeSource(name_, running.Fault()); });
}

void LiveSources::Runner::Note(const std::string& fault) {
  view_.TakeSource(name_, fault);
  if (std::exchange(noted_, fault) == fault) return;
  spdlog::warn("source {} fails: {}; trying again every {} s", name_, fault, kRetry.count());
}

}  // namespace telltale
