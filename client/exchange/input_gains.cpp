#include "telltale/client/exchange/input_gains.hpp"

#include <algorithm>

#include "telltale/core/base/contract.hpp"
#include "telltale/idl/codec/json/json_message.hpp"
#include "telltale/idl/codec/json/model.hpp"
#include "telltale/idl/proto/gain.pb.h"

namespace telltale {
namespace {

void Write(double estimate, double standard_error, const Interval& interval,
           proto::Bounded& message) {
  message.set_estimate(estimate);
  message.set_standard_error(standard_error);
  message.mutable_interval()->set_level(interval.level);
  message.mutable_interval()->set_lower(interval.lower);
  message.mutable_interval()->set_upper(interval.upper);
}

void Write(const Identification& identification, const InputGain& gain, Equation equation,
           proto::Bounded& message) {
  const auto axis = static_cast<Eigen::Index>(IndexOf(equation));
  Write(gain.gain[axis], gain.StandardErrors()[axis], BoundsOf(identification, gain, equation),
        message);
}

void Write(const Identification& identification, const CommandGain& command,
           proto::CommandGain& message) {
  message.set_port(command.delta.port);
  message.set_starboard(command.delta.starboard);
  message.set_region(std::string(Name(RegionOf(command.delta))));
  const InputGain discrete = command.gain.Times(identification.sampling_period_s);
  for (const Equation equation : kEquations) {
    if (!identification.Has(equation)) continue;
    proto::AxisGain& axis = equation == Equation::kSurge  ? *message.mutable_surge()
                            : equation == Equation::kSway ? *message.mutable_sway()
                                                          : *message.mutable_yaw();
    Write(identification, command.gain, equation, *axis.mutable_continuous());
    Write(identification, discrete, equation, *axis.mutable_discrete());
  }
}

bool IsForward(const CommandGain& command) {
  return RegionOf(command.delta) == PropellerRegion::kFF;
}

}  // namespace

Settling SettlingOf(const Identification& identification) {
  Require(identification.thruster_time_constant.has_value(), "a thruster time constant");
  const Coefficient& tau = *identification.thruster_time_constant;
  const double per_time_constant = SettlingTime(1.0);
  return {SettlingTime(tau.estimate),
          per_time_constant * tau.standard_error,
          {tau.interval.level, per_time_constant * tau.interval.lower,
           per_time_constant * tau.interval.upper}};
}

Interval BoundsOf(const Identification& identification, const InputGain& gain, Equation equation) {
  Require(!identification.coefficients.empty(), "a model with coefficients");
  const auto axis = static_cast<Eigen::Index>(IndexOf(equation));
  return NormalInterval(gain.gain[axis], gain.StandardErrors()[axis],
                        identification.coefficients.front().interval.level);
}

std::vector<std::string> NotesOn(const Identification& identification,
                                 std::span<const CommandGain> gains) {
  std::vector<std::string> notes;
  if (HasLag(identification.structure)) {
    notes.emplace_back("Gains are those of thrust that has settled; it lags behind its command.");
  } else {
    notes.emplace_back("Thrust follows its command at once: no initial condition has to settle.");
  }
  if (identification.parameterization == Parameterization::kPaper &&
      !std::all_of(gains.begin(), gains.end(), IsForward)) {
    notes.emplace_back(
        "The paper's surge equation knows the forward thrust curve alone: outside FF its gain is "
        "that curve's, not the boat's.");
  }
  return notes;
}

std::string PrintGainsJson(const Identification& identification,
                           std::span<const CommandGain> gains) {
  proto::InputGains message;
  message.set_vehicle_id(identification.vehicle_id);
  message.set_structure(ToProto(identification).structure());
  message.set_sampling_period_s(identification.sampling_period_s);
  for (const CommandGain& command : gains) Write(identification, command, *message.add_gains());
  if (identification.thruster_time_constant) {
    const Settling settling = SettlingOf(identification);
    Write(settling.estimate_s, settling.standard_error_s, settling.interval,
          *message.mutable_settling_time_s());
  }
  for (const std::string& note : NotesOn(identification, gains)) message.add_notes(note);
  return PrintJsonMessage(message);
}

}  // namespace telltale
