#include "telltale/client/workbench/check_log.hpp"

#include <utility>

#include "telltale/client/recording/telemetry_log/telemetry_log.hpp"
#include "telltale/client/workbench/default_threads.hpp"
#include "telltale/core/data/preparation.hpp"
#include "telltale/core/data/repeated_readings.hpp"

namespace telltale {
namespace {

struct CheckedRecording {
  CheckedLog log;
  Recording recording;  ///< empty where the log is unusable
};

CheckedRecording Check(const std::filesystem::path& path, RawLog log, const Vehicle& vehicle) {
  CheckedRecording checked;
  CheckedLog& said = checked.log;
  said.path = path;
  if (log.description) said.summary = std::move(log.description->summary);
  said.check = CheckInput(log.channels.gnss, log.channels.heading, log.channels.thrusters, vehicle);
  said.lacks = std::move(log.lacks);
  if (!said.lacks.empty()) {
    said.unusable = said.lacks.front();
    return checked;
  }
  auto admitted = Admit(std::move(log.channels));
  if (!admitted) {
    said.unusable = std::move(admitted).error();
    return checked;
  }
  checked.recording = std::move(admitted->recording);
  if (auto measured = WithoutRepeatedReadings(checked.recording)) {
    checked.recording = *std::move(measured);
  }
  said.rejected = checked.recording.rejected;
  said.unusable = WhyNotPrepared(checked.recording, PrepareOptions::Robust());
  return checked;
}

Result<ChannelDelays> DelaysOf(const CheckedRecording& checked, const Vehicle& vehicle,
                               const Progress& progress) {
  const CheckedLog& said = checked.log;
  if (!said.lacks.empty()) {
    return Refuse("delays", "they need all three channels", "record the missing ones");
  }
  if (!said.check.faults.empty()) {
    return Refuse("delays", "a fault of input hides them", "mend the fault and check again");
  }
  if (said.unusable) return tl::unexpected(*said.unusable);
  return EstimateChannelDelays(checked.recording, vehicle, DefaultThreads(), progress);
}

}  // namespace

std::optional<Refusal> CheckedLog::FirstProblem() const {
  if (auto fault = FirstFault(check)) return fault;
  return unusable;
}

CheckedLog CheckLog(const std::filesystem::path& path, RawLog log, const Vehicle& vehicle,
                    const Progress& progress) {
  CheckedRecording checked = Check(path, std::move(log), vehicle);
  checked.log.delays = DelaysOf(checked, vehicle, progress);
  return std::move(checked.log);
}

Vehicle DescribedOrUsualVehicle(const std::optional<LogDescription>& description) {
  if (description) {
    if (auto described = VehicleFrom(*description, "log")) return *std::move(described);
  }
  return {};
}

}  // namespace telltale
