#include "telltale/core/diagnosis/delays/recording_delays.hpp"

#include <mutex>

#include "telltale/core/base/parallel.hpp"
#include "telltale/core/diagnosis/diagnosis_constants.hpp"
#include "telltale/core/identification/physical_estimate.hpp"

namespace telltale {
namespace {

constexpr TimingPrior kTiming{kDiagnosis.delays.time_constant_sd_s, kDiagnosis.delays.delay_sd_s};

FossenParameter ParameterOf(DelayedChannel channel) {
  return channel == DelayedChannel::kCommands ? FossenParameter::kCommandDelay
                                              : FossenParameter::kFixDelay;
}

}  // namespace

std::optional<RecordingDelays> RecordingDelaysOf(const PreparedDataset& recording,
                                                 const PhysicalModel& model) {
  Vehicle vehicle;
  vehicle.propeller_separation_m = model.propeller_separation_m;
  vehicle.hull = recording.hull;
  IdentifyOptions options;
  options.posterior_draws = kDiagnosis.delays.posterior_draws;
  const auto own = PhysicalModelAbout(model, kTiming, recording, vehicle, options);
  if (!own) return std::nullopt;
  RecordingDelays delays;
  for (std::size_t i = 0; i < delays.size(); ++i) {
    const auto place = static_cast<std::size_t>(ParameterOf(kDelayedChannels[i]));
    delays[i] = {own->parameters[place].estimate, own->parameters[place].standard_error};
  }
  return delays;
}

ComparedDelays ComparedDelaysOf(const PreparedDataset& recording,
                                const std::vector<PreparedDataset>& references,
                                const PhysicalModel& model, std::size_t threads,
                                const std::function<void(double)>& report_progress) {
  const std::size_t recordings = references.size() + 1;
  ComparedDelays delays;
  delays.references.resize(references.size());
  std::mutex reporting;
  std::size_t done = 0;
  ForEachIndex(recordings, threads, [&](std::size_t i) {
    if (i == references.size()) {
      delays.recording = RecordingDelaysOf(recording, model);
    } else {
      delays.references[i] = RecordingDelaysOf(references[i], model);
    }
    const std::lock_guard lock(reporting);
    report_progress(static_cast<double>(++done) / static_cast<double>(recordings));
  });
  return delays;
}

}  // namespace telltale
