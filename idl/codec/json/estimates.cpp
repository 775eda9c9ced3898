#include "telltale/idl/codec/json/estimates.hpp"

#include <string>

#include "telltale/core/identification/drag_and_thrust.hpp"
#include "telltale/idl/codec/json/coefficient.hpp"
#include "telltale/idl/codec/json/effects.hpp"
#include "telltale/idl/codec/json/proto_values.hpp"
#include "telltale/idl/codec/model_rules.hpp"

namespace telltale {
namespace {

using Numbers = google::protobuf::RepeatedField<double>;

// ---- to Protobuf --------------------------------------------------------------------------------

void Write(const Disturbance& disturbance, proto::Disturbance& message) {
  message.mutable_sigma()->Add(disturbance.sigma.begin(), disturbance.sigma.end());
  message.mutable_time_constant_s()->Add(disturbance.time_constant_s.begin(),
                                         disturbance.time_constant_s.end());
  message.set_gnss_drift_m(disturbance.gnss_drift_m);
}

void Write(const RecordingBias& recording_bias, proto::RecordingBias& message) {
  message.set_start_s(recording_bias.start_s);
  message.set_end_s(recording_bias.end_s);
  for (const Coefficient& coefficient : recording_bias.coefficients) {
    *message.add_coefficients() = ToProto(coefficient);
  }
}

void WriteRowMajor(const Eigen::MatrixXd& matrix, Numbers& numbers) {
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    for (Eigen::Index column = 0; column < matrix.cols(); ++column) {
      numbers.Add(matrix(row, column));
    }
  }
}

void WriteJoint(const Identification& identification, proto::JointBounds& message) {
  message.set_covariance_factor(identification.joint->covariance_factor);
  message.set_degrees_of_freedom(identification.joint->degrees_of_freedom);
  message.set_squared_radius(SquaredRadius(identification).value_or(0.0));
}

// ---- from Protobuf ------------------------------------------------------------------------------

/// The numbers alone, over `n` coefficients or parameters.
Eigen::MatrixXd ReadCovariance(FieldReader& reader, const char* field, const Numbers& numbers,
                               int n, const std::string& of) {
  if (numbers.size() != n * n) {
    reader.Fail(field, std::to_string(numbers.size()) + " numbers",
                std::to_string(n * n) + ", the square of " + std::to_string(n) + ' ' + of);
    return {};
  }
  Eigen::MatrixXd covariance(n, n);
  for (int i = 0; i < n * n; ++i) covariance(i / n, i % n) = numbers[i];
  return covariance;
}

std::optional<Coefficient> ReadTimeConstant(FieldReader& reader, const proto::Model& model,
                                            Structure structure) {
  const bool dynamic = HasLag(structure);
  if (model.has_thruster_time_constant_s() != dynamic) {
    reader.Fail("thruster_time_constant_s", dynamic ? "" : "(given)",
                "given for FIRST_ORDER_DYNAMIC and FOSSEN, and for nothing else");
  }
  if (!dynamic) return std::nullopt;
  FieldReader item = reader.Optional("thruster_time_constant_s");
  item.Number("estimate", kFinitePositive);
  return ReadCoefficient(item, model.thruster_time_constant_s());
}

void ExpectFinite(FieldReader& reader, const char* field, const Numbers& numbers) {
  for (int i = 0; i < numbers.size(); ++i) {
    if (kFinite.Contains(numbers[i])) continue;
    reader.FailItem(field, i, NumberText(numbers[i]), kFinite.Text());
  }
}

/// No numbers stand for zeros.
Eigen::VectorXd ReadTimeConstantCovariance(FieldReader& reader, const proto::Model& model,
                                           Structure structure) {
  constexpr const char* kField = "thruster_time_constant_covariance";
  const Numbers& numbers = model.thruster_time_constant_covariance();
  const int n = HasLag(structure) ? model.coefficients_size() : 0;
  if (numbers.empty()) return Eigen::VectorXd::Zero(n);
  if (numbers.size() != n) {
    reader.Fail(kField, std::to_string(numbers.size()) + " numbers",
                n == 0 ? "given for FIRST_ORDER_DYNAMIC and FOSSEN, and for nothing else"
                       : std::to_string(n) + ", one for each coefficient");
    return {};
  }
  ExpectFinite(reader, kField, numbers);
  return Eigen::Map<const Eigen::VectorXd>(numbers.data(), n);
}

Eigen::Vector3d ReadAxes(FieldReader& reader, const char* field, const Numbers& values,
                         FieldRange range) {
  if (values.size() != 3) {
    reader.Fail(field, std::to_string(values.size()) + " numbers", "3, one for each axis");
    return Eigen::Vector3d::Ones();
  }
  for (const double value : values) {
    if (!range.Contains(value)) reader.Fail(field, NumberText(value), range.Text());
  }
  return {values[0], values[1], values[2]};
}

Disturbance ReadDisturbance(FieldReader reader, const proto::Disturbance& message) {
  return {ReadAxes(reader, "sigma", message.sigma(), kFiniteNotNegative),
          ReadAxes(reader, "time_constant_s", message.time_constant_s(), kDisturbanceTimeConstantS),
          reader.Number("gnss_drift_m", kFiniteNotNegative, 0.0)};
}

RecordingBias ReadRecordingBias(FieldReader reader, const proto::RecordingBias& message) {
  RecordingBias recording_bias;
  recording_bias.start_s = reader.Number("start_s", kFinite);
  recording_bias.end_s = reader.Number("end_s", {recording_bias.start_s, kLargest});
  recording_bias.coefficients =
      ReadAll(reader, "coefficients", message.coefficients(), ReadCoefficient);
  return recording_bias;
}

DeadZone ReadDeadZone(FieldReader reader) {
  return {reader.Number("forward", kDeadZoneForward), reader.Number("reverse", kDeadZoneReverse)};
}

/// The radius follows from the other fields.
JointBounds ReadJoint(FieldReader reader) {
  return {reader.Number("covariance_factor", kFinitePositive),
          reader.Number("degrees_of_freedom", kDegreesOfFreedom)};
}

std::vector<double> ReadSimulationParameters(FieldReader& reader, const proto::Model& model) {
  const auto& numbers = model.simulation();
  if (!numbers.empty() && numbers.size() != model.coefficients_size()) {
    reader.Fail("simulation", std::to_string(numbers.size()) + " numbers",
                std::to_string(model.coefficients_size()) + ", one for each coefficient, or none");
  }
  ExpectFinite(reader, "simulation", numbers);
  return {numbers.begin(), numbers.end()};
}

// ---- the physical form --------------------------------------------------------------------------

void Write(const PhysicalModel& physical, proto::Model& message) {
  for (const Coefficient& parameter : physical.parameters) {
    *message.add_parameters() = ToProto(parameter);
  }
  WriteRowMajor(physical.covariance, *message.mutable_parameter_covariance());
  message.set_propeller_separation_m(physical.propeller_separation_m);
  const auto parameter = [&](FossenParameter at) {
    return ToProto(physical.parameters[static_cast<std::size_t>(at)]);
  };
  *message.mutable_delays()->mutable_commands() = parameter(FossenParameter::kCommandDelay);
  *message.mutable_delays()->mutable_fixes() = parameter(FossenParameter::kFixDelay);
  for (const ForceAtPoint& force : DragAndThrustOf(physical)) {
    proto::ForceAtPoint& to = *message.add_drag_and_thrust();
    to.set_name(force.name);
    to.set_at(force.at);
    to.set_at_unit(force.at_unit);
    to.set_estimate(force.estimate);
    Write(force.interval, *to.mutable_interval());
    to.set_unit(force.unit);
  }
  const NoiseModel& noise = physical.noise;
  proto::FilterNoise& filter = *message.mutable_filter_noise();
  filter.mutable_acceleration_sigma()->Add(noise.acceleration_sigma.begin(),
                                           noise.acceleration_sigma.end());
  filter.set_acceleration_time_constant_s(noise.acceleration_time_constant_s);
  filter.set_fix_drift_sigma_m(noise.fix_drift_sigma_m);
  filter.set_fix_sigma_m(noise.fix_sigma_m);
  filter.set_heading_sigma_rad(noise.heading_sigma_rad);
  filter.set_stamp_sigma_s(noise.stamp_sigma_s);
}

NoiseModel ReadNoise(FieldReader reader, const proto::FilterNoise& message) {
  NoiseModel noise;
  noise.acceleration_sigma =
      ReadAxes(reader, "acceleration_sigma", message.acceleration_sigma(), kFinitePositive);
  noise.acceleration_time_constant_s =
      reader.Number("acceleration_time_constant_s", kFinitePositive);
  noise.fix_drift_sigma_m = reader.Number("fix_drift_sigma_m", kFinitePositive);
  noise.fix_sigma_m = reader.Number("fix_sigma_m", kFinitePositive);
  noise.heading_sigma_rad = reader.Number("heading_sigma_rad", kFinitePositive);
  noise.stamp_sigma_s = reader.Number("stamp_sigma_s", kFinitePositive);
  return noise;
}

Coefficient ReadParameter(FieldReader reader, const proto::Coefficient& message) {
  Coefficient parameter;
  parameter.symbol = message.symbol();
  parameter.unit = message.unit();
  parameter.estimate = reader.Number("estimate", kFinite);
  parameter.standard_error = reader.Number("standard_error", kFiniteNotNegative);
  parameter.interval = {message.interval().level(), message.interval().lower(),
                        message.interval().upper()};
  parameter.status = ReadEnum<CoefficientStatus>(reader, "status", message.status());
  return parameter;
}

std::optional<PhysicalModel> ReadPhysical(FieldReader& reader, const proto::Model& model,
                                          Structure structure) {
  if (structure != Structure::kFossen) {
    if (model.parameters_size() > 0) {
      reader.Fail("parameters", "(given)", "given for FOSSEN and for nothing else");
    }
    return std::nullopt;
  }
  PhysicalModel physical;
  physical.parameters = ReadAll(reader, "parameters", model.parameters(), ReadParameter);
  if (const auto fault = ParametersFault("parameters", physical.parameters)) {
    reader.Fail("parameters", fault->value, fault->allowed);
  }
  physical.covariance = ReadCovariance(reader, "parameter_covariance", model.parameter_covariance(),
                                       model.parameters_size(), "parameters");
  ExpectFinite(reader, "parameter_covariance", model.parameter_covariance());
  physical.propeller_separation_m = reader.Number("propeller_separation_m", kFinitePositive);
  physical.noise = ReadNoise(reader.Optional("filter_noise"), model.filter_noise());
  return physical;
}

}  // namespace

void WriteEstimates(const Identification& identification, proto::Model& message) {
  for (const Coefficient& coefficient : identification.coefficients) {
    *message.add_coefficients() = ToProto(coefficient);
  }
  WriteRowMajor(identification.covariance, *message.mutable_covariance());
  if (identification.joint) WriteJoint(identification, *message.mutable_joint());
  if (const auto& time_constant = identification.thruster_time_constant) {
    *message.mutable_thruster_time_constant_s() = ToProto(*time_constant);
  }
  const Eigen::VectorXd& with_tau = identification.time_constant_covariance;
  message.mutable_thruster_time_constant_covariance()->Add(with_tau.begin(), with_tau.end());
  message.mutable_dead_zone()->set_forward(identification.dead_zone.forward);
  message.mutable_dead_zone()->set_reverse(identification.dead_zone.reverse);
  if (const auto& disturbance = identification.disturbance) {
    Write(*disturbance, *message.mutable_disturbance());
  }
  for (const RecordingBias& recording_bias : identification.recording_bias) {
    Write(recording_bias, *message.add_recording_bias());
  }
  WriteEffects(identification.effects, message);
  message.mutable_simulation()->Add(identification.simulation.begin(),
                                    identification.simulation.end());
  if (identification.physical) Write(*identification.physical, message);
}

void ReadEstimates(FieldReader& reader, const proto::Model& message,
                   Identification& identification) {
  identification.coefficients =
      ReadAll(reader, "coefficients", message.coefficients(), ReadCoefficient);
  identification.dead_zone = ReadDeadZone(reader.Optional("dead_zone"));
  identification.covariance = ReadCovariance(reader, "covariance", message.covariance(),
                                             message.coefficients_size(), "coefficients");
  identification.thruster_time_constant =
      ReadTimeConstant(reader, message, identification.structure);
  identification.time_constant_covariance =
      ReadTimeConstantCovariance(reader, message, identification.structure);
  if (message.has_disturbance()) {
    identification.disturbance =
        ReadDisturbance(reader.Optional("disturbance"), message.disturbance());
  }
  identification.recording_bias =
      ReadAll(reader, "recording_bias", message.recording_bias(), ReadRecordingBias);
  identification.effects = ReadEffects(reader, message);
  identification.simulation = ReadSimulationParameters(reader, message);
  identification.physical = ReadPhysical(reader, message, identification.structure);
  if (message.has_joint()) identification.joint = ReadJoint(reader.Optional("joint"));
}

}  // namespace telltale
