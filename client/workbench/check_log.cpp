#include "telltale/client/workbench/check_log.hpp"

#include <utility>

#include "telltale/client/recording/telemetry_log/telemetry_log.hpp"
#include "telltale/core/data/preparation.hpp"

namespace telltale {

std::optional<Refusal> CheckedLog::FirstProblem() const {
  if (auto fault = FirstFault(check)) return fault;
  return unusable;
}

CheckedLog CheckLog(const std::filesystem::path& path, RawChannels recorded,
                    const std::optional<LogDescription>& description, const Vehicle& vehicle) {
  CheckedLog checked;
  checked.path = path;
  if (description) checked.summary = description->summary;
  checked.check = CheckInput(recorded.gnss, recorded.heading, recorded.thrusters, vehicle);
  const auto admitted = Admit(std::move(recorded));
  if (!admitted) {
    checked.unusable = admitted.error();
    return checked;
  }
  checked.rejected = admitted->recording.rejected;
  checked.unusable = WhyNotPrepared(admitted->recording, PrepareOptions::Robust());
  return checked;
}

Vehicle DescribedOrUsualVehicle(const std::optional<LogDescription>& description) {
  if (description) {
    if (auto described = VehicleFrom(*description, "log")) return *std::move(described);
  }
  return {};
}

}  // namespace telltale
