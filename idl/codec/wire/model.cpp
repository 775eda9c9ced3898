#include "telltale/idl/codec/wire/model.hpp"

#include "telltale/core/effects/effect.hpp"
#include "telltale/idl/codec/model_rules.hpp"
#include "telltale/idl/codec/wire/choices.hpp"
#include "telltale/idl/codec/wire/nested.hpp"
#include "telltale/idl/codec/wire/put.hpp"
#include "telltale/idl/codec/wire/read.hpp"

namespace telltale {
namespace wire {
namespace {

// ---- core -> wire -------------------------------------------------------------------------------

void FillCoefficient(telltale_wire_Coefficient& wire, const Coefficient& coefficient) {
  Put(wire.equation, Name(coefficient.equation));
  Put(wire.regressor, coefficient.regressor);
  Put(wire.symbol, coefficient.symbol);
  wire.estimate = coefficient.estimate;
  wire.standard_error = coefficient.standard_error;
  wire.bounds = {coefficient.interval.level, coefficient.interval.lower,
                 coefficient.interval.upper};
  Put(wire.unit, coefficient.unit);
  Put(wire.status, Name(coefficient.status));
}

void FillCoefficientChange(telltale_wire_CoefficientChange& wire, const CoefficientChange& change) {
  Put(wire.equation, Name(change.equation));
  Put(wire.regressor, change.regressor);
  Put(wire.symbol, change.symbol);
  wire.difference = change.difference;
  wire.standard_error = change.standard_error;
  wire.p_value = change.p_value;
}

void FillModelChange(telltale_wire_ModelChange& wire, const ModelChange& change) {
  wire.revision = change.revision;
  Put(wire.verdict, Name(change.verdict));
  wire.p_value = change.p_value;
  wire.statistic = change.statistic;
  wire.degrees_of_freedom = change.degrees_of_freedom;
  PutSequence(wire.coefficients, change.coefficients, FillCoefficientChange);
  Put(wire.reason, change.reason);
}

void FillRecordingBias(telltale_wire_RecordingBias& wire, const RecordingBias& recording_bias) {
  wire.start_s = recording_bias.start_s;
  wire.end_s = recording_bias.end_s;
  PutSequence(wire.coefficients, recording_bias.coefficients, FillCoefficient);
}

void FillAddedEffect(telltale_wire_AddedEffect& wire, const AddedEffect& added) {
  Put(wire.effect, added.effect);
  PutNumbers(wire.values, added.values);
}

std::vector<double> RowMajor(const Eigen::MatrixXd& matrix) {
  std::vector<double> values;
  values.reserve(static_cast<std::size_t>(matrix.size()));
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    for (Eigen::Index column = 0; column < matrix.cols(); ++column) {
      values.push_back(matrix(row, column));
    }
  }
  return values;
}

void FillPhysicalForm(telltale_wire_PhysicalForm& wire, const PhysicalModel& physical) {
  PutSequence(wire.parameters, physical.parameters, FillCoefficient);
  PutNumbers(wire.covariance, RowMajor(physical.covariance));
  wire.propeller_separation_m = physical.propeller_separation_m;
  const NoiseModel& noise = physical.noise;
  PutNumbers(wire.acceleration_sigma, noise.acceleration_sigma);
  wire.acceleration_time_constant_s = noise.acceleration_time_constant_s;
  wire.fix_drift_sigma_m = noise.fix_drift_sigma_m;
  wire.fix_sigma_m = noise.fix_sigma_m;
  wire.heading_sigma_rad = noise.heading_sigma_rad;
  wire.stamp_sigma_s = noise.stamp_sigma_s;
}

void FillEstimates(telltale_wire_Model& wire, const Identification& identification) {
  PutSequence(wire.coefficients, identification.coefficients, FillCoefficient);
  PutNumbers(wire.covariance, RowMajor(identification.covariance));
  PutOptional(wire.joint, identification.joint,
              [&](telltale_wire_JointBounds& element, const JointBounds& joint) {
                element = {joint.covariance_factor, joint.degrees_of_freedom,
                           SquaredRadius(identification).value_or(0.0)};
              });
  PutOptional(wire.thruster_time_constant, identification.thruster_time_constant, FillCoefficient);
  PutNumbers(wire.thruster_time_constant_covariance, identification.time_constant_covariance);
  wire.dead_zone_forward = identification.dead_zone.forward;
  wire.dead_zone_reverse = identification.dead_zone.reverse;
  if (const auto& disturbance = identification.disturbance) {
    PutNumbers(wire.disturbance_sigma, disturbance->sigma);
    PutNumbers(wire.disturbance_time_constant_s, disturbance->time_constant_s);
    wire.gnss_drift_m = disturbance->gnss_drift_m;
  }
  PutSequence(wire.recording_bias, identification.recording_bias, FillRecordingBias);
  PutSequence(wire.effects, identification.effects, FillAddedEffect);
  PutNumbers(wire.simulation, identification.simulation);
  PutOptional(wire.physical, identification.physical, FillPhysicalForm);
}

void FillWindow(telltale_wire_Model& wire, const WindowSummary& window) {
  wire.window_start_s = window.start_s;
  wire.window_end_s = window.end_s;
  wire.window_samples = window.samples;
  wire.window_segments = window.segments;
  wire.window_slices = window.slices;
  PutSequence(wire.rejected, RejectEntries(window.rejected), FillRejectCount);
}

void FillProvenance(telltale_wire_Model& wire, const Provenance& provenance) {
  Put(wire.preset, provenance.preset);
  Put(wire.bounds_basis, provenance.bounds_basis);
  wire.bootstrap_replicates = provenance.bootstrap_replicates;
  wire.bootstrap_failures = provenance.bootstrap_failures;
  wire.seed = provenance.seed;
  Put(wire.software_version, provenance.software_version);
  wire.parametric_replicates = provenance.parametric_replicates;
  wire.parametric_replicate_failures = provenance.parametric_replicate_failures;
  Put(wire.structure_choice, provenance.structure_choice);
  Put(wire.estimator_choice, provenance.estimator_choice);
  wire.misspecification = provenance.misspecification;
  wire.clusters = provenance.clusters;
  PutOptional(wire.change, provenance.change, FillModelChange);
}

// ---- wire -> core -------------------------------------------------------------------------------

Coefficient ReadCoefficient(const std::string& field, const telltale_wire_Coefficient& wire) {
  Coefficient coefficient;
  coefficient.equation = ReadOptionalName(
      field + ".equation",
      View(wire.equation) == Name(Equation::kUnknown) ? "" : View(wire.equation), kEquations);
  coefficient.regressor = View(wire.regressor);
  coefficient.symbol = View(wire.symbol);
  coefficient.estimate = ReadWithin(field + ".estimate", wire.estimate, kFinite);
  coefficient.standard_error =
      ReadWithin(field + ".standard_error", wire.standard_error, kNotNegative);
  coefficient.interval.level =
      ReadWithin(field + ".bounds.level", wire.bounds.level, kIntervalLevel);
  coefficient.interval.lower = ReadWithin(field + ".bounds.lower", wire.bounds.lower, kNotNan);
  coefficient.interval.upper =
      ReadWithin(field + ".bounds.upper", wire.bounds.upper, {wire.bounds.lower, kNotNan.high});
  coefficient.unit = View(wire.unit);
  coefficient.status = ReadName(field + ".status", View(wire.status), kCoefficientStatuses);
  return coefficient;
}

/// A covariance over `count` coefficients or parameters.
Eigen::MatrixXd ReadCovariance(const std::string& field, const dds_sequence_double& wire,
                               std::size_t count, const char* of) {
  if (wire._length != count * count) {
    Reject(field, std::to_string(wire._length) + " numbers",
           std::to_string(count * count) + ", the square of the number of " + of);
  }
  const auto n = static_cast<Eigen::Index>(count);
  Eigen::MatrixXd covariance(n, n);
  for (Eigen::Index row = 0; row < n; ++row) {
    for (Eigen::Index column = 0; column < n; ++column) {
      covariance(row, column) = wire._buffer[row * n + column];
    }
  }
  return covariance;
}

/// The radius follows from the other fields.
JointBounds ReadJoint(const std::string& field, const telltale_wire_JointBounds& wire) {
  return {ReadWithin(field + ".covariance_factor", wire.covariance_factor, kFinitePositive),
          ReadWithin(field + ".degrees_of_freedom", wire.degrees_of_freedom, kDegreesOfFreedom)};
}

/// Given for the dynamic structure alone.
std::optional<Coefficient> ReadTimeConstant(const telltale_wire_Model& wire, Structure structure) {
  const bool dynamic = HasLag(structure);
  const auto& constants = wire.thruster_time_constant;
  if (constants._length != (dynamic ? 1u : 0u)) {
    Reject("thruster_time_constant", std::to_string(constants._length) + " items",
           "one for FIRST_ORDER_DYNAMIC, none otherwise");
  }
  if (!dynamic) return std::nullopt;
  const std::string field = "thruster_time_constant[0]";
  ReadWithin(field + ".estimate", constants._buffer[0].estimate, kFinitePositive);
  return ReadCoefficient(field, constants._buffer[0]);
}

/// No numbers stand for zeros.
Eigen::VectorXd ReadTimeConstantCovariance(const dds_sequence_double& wire, Structure structure,
                                           std::size_t coefficients) {
  const bool dynamic = HasLag(structure);
  const auto n = static_cast<Eigen::Index>(dynamic ? coefficients : 0);
  if (wire._length == 0) return Eigen::VectorXd::Zero(n);
  if (wire._length != n) {
    Reject("thruster_time_constant_covariance", std::to_string(wire._length) + " numbers",
           dynamic ? std::to_string(n) + ", one for each coefficient"
                   : "none but for FIRST_ORDER_DYNAMIC");
  }
  const auto covariance = ReadNumbers("thruster_time_constant_covariance", wire);
  return Eigen::Map<const Eigen::VectorXd>(covariance.data(), n);
}

Eigen::Vector3d ReadAxes(const std::string& field, const dds_sequence_double& values,
                         FieldRange range) {
  if (values._length != 3) {
    Reject(field, std::to_string(values._length) + " numbers", "3, one for each axis, or none");
  }
  Eigen::Vector3d axes;
  for (std::uint32_t i = 0; i < 3; ++i) axes[i] = ReadWithin(field, values._buffer[i], range);
  return axes;
}

std::optional<Disturbance> ReadDisturbance(const telltale_wire_Model& wire) {
  const auto& sigma = wire.disturbance_sigma;
  const auto& time_constant_s = wire.disturbance_time_constant_s;
  if (sigma._length == 0 && time_constant_s._length == 0) return std::nullopt;
  return Disturbance{
      ReadAxes("disturbance_sigma", sigma, kFiniteNotNegative),
      ReadAxes("disturbance_time_constant_s", time_constant_s, kDisturbanceTimeConstantS),
      ReadWithin("gnss_drift_m", wire.gnss_drift_m, kFiniteNotNegative)};
}

RecordingBias ReadRecordingBias(const std::string& field, const telltale_wire_RecordingBias& wire) {
  RecordingBias recording_bias;
  recording_bias.start_s = ReadWithin(field + ".start_s", wire.start_s, kFinite);
  recording_bias.end_s = ReadWithin(field + ".end_s", wire.end_s, {wire.start_s, kLargest});
  recording_bias.coefficients =
      ReadSequence(field + ".coefficients", wire.coefficients, ReadCoefficient);
  return recording_bias;
}

AddedEffect ReadAddedEffect(const std::string& field, const telltale_wire_AddedEffect& wire) {
  const std::string name = TextOf(wire.effect);
  const Effect* effect = FindEffect(name);
  if (!effect) Reject(field + ".effect", name, "an effect of the library");
  const auto parameters = effect->Parameters();
  if (wire.values._length != parameters.size()) {
    Reject(field + ".values", std::to_string(wire.values._length) + " numbers",
           std::to_string(parameters.size()) + ", one for each parameter");
  }
  AddedEffect added{name, {}};
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    added.values.push_back(ReadWithin(field + '.' + std::string(parameters[i].name),
                                      wire.values._buffer[i],
                                      {parameters[i].lower, parameters[i].upper}));
  }
  return added;
}

std::vector<double> ReadSimulationParameters(const dds_sequence_double& wire,
                                             std::size_t coefficients) {
  if (wire._length != 0 && wire._length != coefficients) {
    Reject("simulation", std::to_string(wire._length) + " numbers",
           std::to_string(coefficients) + ", one for each coefficient, or none");
  }
  return ReadNumbers("simulation", wire);
}

NoiseModel ReadNoise(const std::string& field, const telltale_wire_PhysicalForm& wire) {
  const auto positive = [&](const char* name, double value) {
    return ReadWithin(field + '.' + name, value, kFinitePositive);
  };
  return {ReadAxes(field + ".acceleration_sigma", wire.acceleration_sigma, kFinitePositive),
          positive("acceleration_time_constant_s", wire.acceleration_time_constant_s),
          positive("fix_drift_sigma_m", wire.fix_drift_sigma_m),
          positive("fix_sigma_m", wire.fix_sigma_m),
          positive("heading_sigma_rad", wire.heading_sigma_rad),
          positive("stamp_sigma_s", wire.stamp_sigma_s)};
}

PhysicalModel ReadPhysicalForm(const std::string& field, const telltale_wire_PhysicalForm& wire) {
  PhysicalModel physical;
  physical.parameters = ReadSequence(field + ".parameters", wire.parameters, ReadCoefficient);
  if (auto fault = ParametersFault(field + ".parameters", physical.parameters)) {
    throw Malformed{*std::move(fault)};
  }
  physical.covariance = ReadCovariance(field + ".covariance", wire.covariance,
                                       physical.parameters.size(), "parameters");
  for (const double value : physical.covariance.reshaped()) {
    ReadWithin(field + ".covariance", value, kFinite);
  }
  physical.propeller_separation_m =
      ReadWithin(field + ".propeller_separation_m", wire.propeller_separation_m, kFinitePositive);
  physical.noise = ReadNoise(field, wire);
  return physical;
}

/// Given for the physical form alone.
std::optional<PhysicalModel> ReadPhysical(const telltale_wire_Model& wire, Structure structure) {
  const bool fossen = structure == Structure::kFossen;
  if (wire.physical._length != (fossen ? 1u : 0u)) {
    Reject("physical", std::to_string(wire.physical._length) + " items",
           "one for FOSSEN, none otherwise");
  }
  return ReadOptional("physical", wire.physical, ReadPhysicalForm);
}

void ReadEstimates(const telltale_wire_Model& wire, Identification& identification) {
  identification.coefficients = ReadSequence("coefficients", wire.coefficients, ReadCoefficient);
  const std::size_t n = identification.coefficients.size();
  const Structure structure = identification.structure;
  identification.covariance = ReadCovariance("covariance", wire.covariance, n, "coefficients");
  identification.joint = ReadOptional("joint", wire.joint, ReadJoint);
  identification.thruster_time_constant = ReadTimeConstant(wire, structure);
  identification.time_constant_covariance =
      ReadTimeConstantCovariance(wire.thruster_time_constant_covariance, structure, n);
  identification.dead_zone = ReadDeadZone(wire.dead_zone_forward, wire.dead_zone_reverse);
  identification.disturbance = ReadDisturbance(wire);
  identification.recording_bias =
      ReadSequence("recording_bias", wire.recording_bias, ReadRecordingBias);
  identification.effects = ReadSequence("effects", wire.effects, ReadAddedEffect);
  identification.simulation = ReadSimulationParameters(wire.simulation, n);
  identification.physical = ReadPhysical(wire, structure);
}

RejectCounts ReadRejectCounts(const dds_sequence_telltale_wire_RejectCount& sequence) {
  RejectCounts counts;
  for (std::uint32_t i = 0; i < sequence._length; ++i) {
    const auto& wire = sequence._buffer[i];
    const std::string field = "rejected[" + std::to_string(i) + "]";
    const auto channel = ReadName(field + ".channel", View(wire.channel), kChannels);
    const auto reason = ReadName(field + ".reason", View(wire.reason), kRejectReasons);
    counts.Count(channel, reason, wire.count);
  }
  return counts;
}

WindowSummary ReadWindow(const telltale_wire_Model& wire) {
  WindowSummary window;
  window.start_s = ReadWithin("window_start_s", wire.window_start_s, kFinite);
  window.end_s = ReadWithin("window_end_s", wire.window_end_s, {wire.window_start_s, kLargest});
  window.samples = wire.window_samples;
  window.segments = wire.window_segments;
  window.slices = wire.window_slices;
  window.rejected = ReadRejectCounts(wire.rejected);
  return window;
}

CoefficientChange ReadCoefficientChange(const std::string& field,
                                        const telltale_wire_CoefficientChange& wire) {
  return {
      ReadName(field + ".equation", View(wire.equation),
               std::array{Equation::kUnknown, Equation::kSurge, Equation::kSway, Equation::kYaw}),
      TextOf(wire.regressor),
      TextOf(wire.symbol),
      ReadWithin(field + ".difference", wire.difference, kFinite),
      ReadWithin(field + ".standard_error", wire.standard_error, kFinitePositive),
      ReadWithin(field + ".p_value", wire.p_value, kShare)};
}

ModelChange ReadModelChange(const std::string& field, const telltale_wire_ModelChange& wire) {
  ModelChange change;
  change.revision = wire.revision;
  change.verdict = ReadName(field + ".verdict", View(wire.verdict), kChangeVerdicts);
  change.p_value = ReadWithin(field + ".p_value", wire.p_value, kShare);
  change.statistic = ReadWithin(field + ".statistic", wire.statistic, kFiniteNotNegative);
  change.degrees_of_freedom = wire.degrees_of_freedom;
  change.coefficients =
      ReadSequence(field + ".coefficients", wire.coefficients, ReadCoefficientChange);
  change.reason = View(wire.reason);
  return change;
}

Provenance ReadProvenance(const telltale_wire_Model& wire) {
  Provenance provenance;
  provenance.preset = View(wire.preset);
  provenance.bounds_basis = View(wire.bounds_basis);
  provenance.bootstrap_replicates = wire.bootstrap_replicates;
  provenance.bootstrap_failures = wire.bootstrap_failures;
  provenance.seed = wire.seed;
  provenance.software_version = View(wire.software_version);
  provenance.parametric_replicates = wire.parametric_replicates;
  provenance.parametric_replicate_failures = wire.parametric_replicate_failures;
  provenance.structure_choice = View(wire.structure_choice);
  provenance.estimator_choice = View(wire.estimator_choice);
  provenance.misspecification = ReadWithin("misspecification", wire.misspecification, kNotNegative);
  provenance.clusters = wire.clusters;
  provenance.change = ReadOptional("change", wire.change, ReadModelChange);
  return provenance;
}

}  // namespace

void FillModel(telltale_wire_Model& wire, const PublishedModel& model) {
  const Identification& identification = model.identification;
  PutIdentifier(wire.vehicle_id, identification.vehicle_id);
  wire.revision = model.revision;
  wire.published_unix_s = model.published_unix_s;
  Put(wire.structure, Name(identification.structure));
  Put(wire.parameterization, Name(identification.parameterization));
  Put(wire.estimator, Name(identification.estimator));
  wire.sampling_period_s = identification.sampling_period_s;
  FillEstimates(wire, identification);
  FillWindow(wire, identification.window);
  PutSequence(wire.refusals, identification.refusals, FillRefusal);
  FillProvenance(wire, identification.provenance);
  FillIdentifiability(wire, identification);
  PutVerdict(wire.verdict, model.promotion.verdict);
  Put(wire.verdict_reason, model.promotion.reason);
}

PublishedModel ReadModel(const telltale_wire_Model& wire) {
  PublishedModel model;
  model.revision = wire.revision;
  model.published_unix_s =
      ReadWithin("published_unix_s", wire.published_unix_s, kFiniteNotNegative);
  Identification& identification = model.identification;
  identification.vehicle_id = ReadIdentifier("vehicle_id", wire.vehicle_id);
  identification.structure = ReadName("structure", View(wire.structure), kStructures);
  identification.parameterization =
      ReadName("parameterization", View(wire.parameterization), kParameterizations);
  identification.estimator = ReadName("estimator", View(wire.estimator), kModelEstimators);
  identification.sampling_period_s =
      ReadWithin("sampling_period_s", wire.sampling_period_s, kSamplingPeriodS);
  ReadEstimates(wire, identification);
  identification.window = ReadWindow(wire);
  identification.refusals = ReadSequence("refusals", wire.refusals, ReadRefusal);
  identification.provenance = ReadProvenance(wire);
  if (auto fault = ModelFault(identification)) throw Malformed{*std::move(fault)};
  ReadIdentifiability(wire, identification);
  model.promotion = {ReadOptionalName("verdict", View(wire.verdict), kPromotionVerdicts),
                     TextOf(wire.verdict_reason)};
  return model;
}

}  // namespace wire

WireSample<telltale_wire_Model> Encode(const PublishedModel& model) {
  WireSample<telltale_wire_Model> sample;
  wire::FillModel(*sample, model);
  return sample;
}

Decoded<PublishedModel> Decode(const telltale_wire_Model& wire) {
  return wire::Guarded([&] { return wire::ReadModel(wire); });
}

}  // namespace telltale
