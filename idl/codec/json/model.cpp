#include "telltale/idl/codec/json/model.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "telltale/idl/codec/field_reader.hpp"
#include "telltale/idl/codec/json/effects.hpp"
#include "telltale/idl/codec/json/identifiability.hpp"
#include "telltale/idl/codec/json/json_message.hpp"
#include "telltale/idl/codec/json/model_change.hpp"
#include "telltale/idl/codec/json/proto_values.hpp"
#include "telltale/idl/codec/vehicle_file.hpp"

namespace telltale {
namespace {

constexpr FieldRange kSamplingPeriod{0.001, 10.0};
constexpr FieldRange kForwardLimit{0.0, kWidestDeadZone};
constexpr FieldRange kReverseLimit{-kWidestDeadZone, 0.0};

// ---- to Protobuf --------------------------------------------------------------------------

void Write(const Coefficient& coefficient, proto::Coefficient& message) {
  message.set_equation(EnumCast<proto::Equation>(coefficient.equation));
  message.set_regressor(coefficient.regressor);
  message.set_symbol(coefficient.symbol);
  message.set_estimate(coefficient.estimate);
  message.set_standard_error(coefficient.standard_error);
  message.mutable_interval()->set_level(coefficient.interval.level);
  message.mutable_interval()->set_lower(coefficient.interval.lower);
  message.mutable_interval()->set_upper(coefficient.interval.upper);
  message.set_unit(coefficient.unit);
  message.set_status(EnumCast<proto::CoefficientStatus>(coefficient.status));
}

void Write(const RejectCounts& rejected, proto::WindowSummary& message) {
  for (const Channel channel : kChannels) {
    for (const RejectReason reason : kRejectReasons) {
      const std::uint64_t count = rejected.Of(channel, reason);
      if (count == 0) continue;
      proto::RejectCount& entry = *message.add_rejected();
      entry.set_channel(std::string(Name(channel)));
      entry.set_reason(std::string(Name(reason)));
      entry.set_count(Saturated(count));
    }
  }
}

void Write(const WindowSummary& window, proto::WindowSummary& message) {
  message.set_start_s(window.start_s);
  message.set_end_s(window.end_s);
  message.set_samples(Saturated(window.samples));
  message.set_segments(Saturated(window.segments));
  message.set_slices(Saturated(window.slices));
  Write(window.rejected, message);
}

void Write(const Refusal& refusal, proto::Refusal& message) {
  message.set_subject(refusal.subject);
  message.set_reason(refusal.reason);
  message.set_advice(refusal.advice);
}

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
    Write(coefficient, *message.add_coefficients());
  }
}

void Write(const Provenance& provenance, proto::Provenance& message) {
  message.set_preset(provenance.preset);
  message.set_bounds_basis(provenance.bounds_basis);
  message.set_bootstrap_replicates(Saturated(provenance.bootstrap_replicates));
  message.set_bootstrap_failures(Saturated(provenance.bootstrap_failures));
  message.set_seed(provenance.seed);
  message.set_software_version(provenance.software_version);
  message.set_parametric_replicates(Saturated(provenance.parametric_replicates));
  message.set_parametric_replicate_failures(Saturated(provenance.parametric_replicate_failures));
  message.set_estimator_choice(provenance.estimator_choice);
  message.set_misspecification(provenance.misspecification);
  message.set_clusters(Saturated(provenance.clusters));
  if (provenance.change) *message.mutable_change() = ToProto(*provenance.change);
}

// ---- from Protobuf ------------------------------------------------------------------------

template <class Core, class Proto>
Core ReadEnum(FieldReader& reader, const char* field, Proto value, const std::string& allowed) {
  const int last =
      static_cast<int>(google::protobuf::GetEnumDescriptor<Proto>()->value_count() - 1);
  const int number = static_cast<int>(value);
  if (number < 1 || number > last)
    reader.Fail(field, number == 0 ? "" : std::to_string(number), allowed);
  return EnumCast<Core>(value);
}

Interval ReadInterval(FieldReader reader) {
  const Interval interval{reader.Number("level", {0.0, 1.0, true}), reader.Number("lower", kNotNan),
                          reader.Number("upper", kNotNan)};
  if (interval.lower > interval.upper) {
    reader.Fail("lower", NumberText(interval.lower),
                "not above upper = " + NumberText(interval.upper));
  }
  return interval;
}

Coefficient ReadCoefficient(FieldReader reader, const proto::Coefficient& message) {
  Coefficient coefficient;
  coefficient.equation = EnumCast<Equation>(message.equation());
  coefficient.regressor = message.regressor();
  coefficient.symbol = message.symbol();
  coefficient.estimate = reader.Number("estimate", kFinite);
  coefficient.standard_error = reader.Number("standard_error", kNotNegative);
  coefficient.interval = ReadInterval(reader.Required("interval"));
  coefficient.unit = message.unit();
  coefficient.status = ReadEnum<CoefficientStatus>(reader, "status", message.status(),
                                                   "one of ESTIMATED, NOT_EXCITED, COLLINEAR");
  return coefficient;
}

RecordingBias ReadRecordingBias(FieldReader reader, const proto::RecordingBias& message) {
  RecordingBias recording_bias;
  recording_bias.start_s = reader.Number("start_s", kFinite);
  recording_bias.end_s = reader.Number("end_s", kFinite);
  for (int i = 0; i < message.coefficients_size(); ++i) {
    recording_bias.coefficients.push_back(
        ReadCoefficient(reader.Item("coefficients", i), message.coefficients(i)));
  }
  return recording_bias;
}

void Expect(FieldReader& reader, const char* field, const std::string& value,
            std::string_view expected) {
  if (value != expected) reader.Fail(field, Quoted(value), Quoted(expected));
}

// Whether a coefficient stands where the structure of the equation wants it.
void CheckPlace(FieldReader& reader, const Coefficient& coefficient, Equation equation,
                const Regressor& regressor) {
  if (coefficient.equation != equation) {
    reader.Fail("equation", std::string(Name(coefficient.equation)),
                std::string(Name(equation)) + ", whose regressor " + Quoted(regressor.name) +
                    " is still missing");
  }
  Expect(reader, "regressor", coefficient.regressor, regressor.name);
  Expect(reader, "symbol", coefficient.symbol, regressor.symbol);
  Expect(reader, "unit", coefficient.unit, regressor.unit);
}

// An equation is there whole or not at all; `next` is the coefficient to be placed.
void CheckEquation(FieldReader& reader, const std::vector<Coefficient>& coefficients,
                   Equation equation, Parameterization parameterization, std::size_t& next) {
  if (next == coefficients.size() || coefficients[next].equation != equation) return;
  for (const Regressor& regressor : Regressors(equation, parameterization)) {
    if (next == coefficients.size()) {
      return reader.Fail(
          "coefficients", std::to_string(coefficients.size()) + " entries",
          std::string(Name(equation)) + " goes on with regressor " + Quoted(regressor.name));
    }
    FieldReader item = reader.Item("coefficients", static_cast<int>(next));
    CheckPlace(item, coefficients[next++], equation, regressor);
  }
}

void CheckOrder(FieldReader& reader, const std::vector<Coefficient>& coefficients,
                Parameterization parameterization) {
  if (coefficients.empty()) reader.Fail("coefficients", "(none)", "at least one equation");
  std::size_t next = 0;
  for (const Equation equation : kEquations) {
    CheckEquation(reader, coefficients, equation, parameterization, next);
  }
  if (next < coefficients.size()) {
    reader.Item("coefficients", static_cast<int>(next))
        .Fail("equation", std::string(Name(coefficients[next].equation)),
              "SURGE, SWAY, YAW in this order, each at most once");
  }
}

bool Symmetric(double a, double b, double variance_a, double variance_b) {
  constexpr double kRounding = 1e-9;  // far above what printing 17 digits loses
  return std::abs(a - b) <= kRounding * std::sqrt(variance_a * variance_b) || a == b;
}

Eigen::MatrixXd ReadCovariance(FieldReader& reader, const proto::Model& model) {
  const int n = model.coefficients_size();
  if (model.covariance_size() != n * n) {
    reader.Fail("covariance", std::to_string(model.covariance_size()) + " numbers",
                std::to_string(n * n) + ", the square of " + std::to_string(n) + " coefficients");
    return {};
  }
  Eigen::MatrixXd covariance(n, n);
  for (int i = 0; i < n * n; ++i) {
    const bool variance = i / n == i % n;
    const FieldRange range = variance ? kNotNegative : kFinite;
    covariance(i / n, i % n) = model.covariance(i);
    if (range.Contains(model.covariance(i))) continue;
    reader.FailItem("covariance", i, NumberText(model.covariance(i)), range.Text());
  }
  for (int row = 0; row < n; ++row) {
    for (int column = 0; column < row; ++column) {
      const double mirrored = covariance(column, row);
      if (Symmetric(covariance(row, column), mirrored, covariance(row, row),
                    covariance(column, column))) {
        continue;
      }
      reader.FailItem("covariance", row * n + column, NumberText(covariance(row, column)),
                      "a symmetric matrix, so " + NumberText(mirrored));
    }
  }
  return covariance;
}

DeadZone ReadDeadZone(FieldReader reader) {
  return {reader.Number("forward", kForwardLimit), reader.Number("reverse", kReverseLimit)};
}

std::optional<Coefficient> ReadTimeConstant(FieldReader& reader, const proto::Model& model,
                                            Structure structure) {
  const bool dynamic = structure == Structure::kFirstOrderDynamic;
  if (model.has_thruster_time_constant_s() != dynamic) {
    reader.Fail("thruster_time_constant_s", dynamic ? "" : "(given)",
                "given for FIRST_ORDER_DYNAMIC and for nothing else");
  }
  if (!dynamic) return std::nullopt;
  FieldReader item = reader.Optional("thruster_time_constant_s");
  item.Number("estimate", kFinitePositive);
  return ReadCoefficient(item, model.thruster_time_constant_s());
}

void ExpectFinite(FieldReader& reader, const char* field, const auto& numbers) {
  for (int i = 0; i < numbers.size(); ++i) {
    if (kFinite.Contains(numbers[i])) continue;
    reader.FailItem(field, i, NumberText(numbers[i]), kFinite.Text());
  }
}

/// None stands for zero: older files know of none.
Eigen::VectorXd ReadTimeConstantCovariance(FieldReader& reader, const proto::Model& model,
                                           Structure structure) {
  constexpr const char* kField = "thruster_time_constant_covariance";
  const auto& numbers = model.thruster_time_constant_covariance();
  const int n = structure == Structure::kFirstOrderDynamic ? model.coefficients_size() : 0;
  if (numbers.empty()) return Eigen::VectorXd::Zero(n);
  if (numbers.size() != n) {
    reader.Fail(kField, std::to_string(numbers.size()) + " numbers",
                n == 0 ? "given for FIRST_ORDER_DYNAMIC and for nothing else"
                       : std::to_string(n) + ", one for each coefficient");
    return {};
  }
  ExpectFinite(reader, kField, numbers);
  return Eigen::Map<const Eigen::VectorXd>(numbers.data(), n);
}

template <class Value, std::size_t N>
Value ReadName(FieldReader& reader, const char* field, const std::string& name,
               const std::array<Value, N>& values) {
  std::string allowed;
  for (const Value value : values) {
    if (Name(value) == name) return value;
    allowed += (allowed.empty() ? "one of " : ", ") + std::string(Name(value));
  }
  reader.Fail(field, Quoted(name), allowed);
  return values.front();
}

WindowSummary ReadWindow(FieldReader reader, const proto::WindowSummary& message) {
  WindowSummary window;
  window.start_s = reader.Number("start_s", kFinite);
  window.end_s = reader.Number("end_s", kFinite);
  if (window.start_s > window.end_s) {
    reader.Fail("start_s", NumberText(window.start_s),
                "not after endS = " + NumberText(window.end_s));
  }
  window.samples = message.samples();
  window.segments = message.segments();
  window.slices = message.slices();
  for (int i = 0; i < message.rejected_size(); ++i) {
    FieldReader item = reader.Item("rejected", i);
    const proto::RejectCount& entry = message.rejected(i);
    const Channel channel = ReadName(item, "channel", entry.channel(), kChannels);
    const RejectReason reason = ReadName(item, "reason", entry.reason(), kRejectReasons);
    window.rejected.Count(channel, reason, entry.count());
  }
  return window;
}

std::vector<Refusal> ReadRefusals(const proto::Model& model) {
  std::vector<Refusal> refusals;
  for (const proto::Refusal& refusal : model.refusals()) {
    refusals.push_back({refusal.subject(), refusal.reason(), refusal.advice()});
  }
  return refusals;
}

Provenance ReadProvenance(FieldReader reader, const proto::Provenance& message) {
  Provenance provenance;
  provenance.preset = message.preset();
  provenance.bounds_basis = message.bounds_basis();
  provenance.bootstrap_replicates = message.bootstrap_replicates();
  provenance.bootstrap_failures = message.bootstrap_failures();
  provenance.seed = message.seed();
  provenance.software_version = message.software_version();
  provenance.parametric_replicates = message.parametric_replicates();
  provenance.parametric_replicate_failures = message.parametric_replicate_failures();
  provenance.estimator_choice = message.estimator_choice();
  provenance.misspecification = reader.Number("misspecification", kNotNegative, 0.0);
  provenance.clusters = message.clusters();
  if (message.has_change()) {
    provenance.change = ReadModelChange(reader.Optional("change"), message.change());
  }
  return provenance;
}

Eigen::Vector3d ReadAxes(FieldReader& reader, const char* field,
                         const google::protobuf::RepeatedField<double>& values, double least) {
  if (values.size() != 3) {
    reader.Fail(field, std::to_string(values.size()) + " numbers", "3, one for each axis");
    return Eigen::Vector3d::Ones();
  }
  for (const double value : values) {
    if (value >= least && std::isfinite(value)) continue;
    reader.Fail(field, NumberText(value), "[" + NumberText(least) + ", inf)");
  }
  return {values[0], values[1], values[2]};
}

Disturbance ReadDisturbance(FieldReader reader, const proto::Disturbance& message) {
  constexpr double kShortestS = 1e-3;
  return {ReadAxes(reader, "sigma", message.sigma(), 0.0),
          ReadAxes(reader, "time_constant_s", message.time_constant_s(), kShortestS),
          reader.Number("gnss_drift_m", kNotNegative, 0.0)};
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

/// The radius follows from the rest.
JointBounds ReadJoint(FieldReader reader) {
  return {reader.Number("covariance_factor", kFinitePositive),
          reader.Number("degrees_of_freedom", {1.0, kLargest})};
}

void WriteJoint(const Identification& identification, proto::JointBounds& message) {
  message.set_covariance_factor(identification.joint->covariance_factor);
  message.set_degrees_of_freedom(identification.joint->degrees_of_freedom);
  message.set_squared_radius(SquaredRadius(identification).value_or(0.0));
}

Identification ReadModel(FieldReader reader, const proto::Model& model) {
  Identification result;
  result.vehicle_id = model.vehicle_id();
  if (!IsVehicleId(result.vehicle_id)) {
    reader.Fail("vehicle_id", Quoted(result.vehicle_id), std::string(kVehicleIdAllowed));
  }
  result.structure = ReadEnum<Structure>(reader, "structure", model.structure(),
                                         "one of STATIC_QUADRATIC, FIRST_ORDER_DYNAMIC");
  result.parameterization = ReadEnum<Parameterization>(
      reader, "parameterization", model.parameterization(), "one of PROPELLER, PAPER");
  result.estimator = ReadEnum<Estimator>(reader, "estimator", model.estimator(),
                                         "one of ONE_STEP, WEAK_IV, OUTPUT_ERROR");
  result.sampling_period_s = reader.Number("sampling_period_s", kSamplingPeriod);
  for (int i = 0; i < model.coefficients_size(); ++i) {
    result.coefficients.push_back(
        ReadCoefficient(reader.Item("coefficients", i), model.coefficients(i)));
  }
  result.dead_zone = ReadDeadZone(reader.Optional("dead_zone"));
  result.covariance = ReadCovariance(reader, model);
  result.thruster_time_constant = ReadTimeConstant(reader, model, result.structure);
  result.time_constant_covariance = ReadTimeConstantCovariance(reader, model, result.structure);
  if (model.has_disturbance()) {
    result.disturbance = ReadDisturbance(reader.Optional("disturbance"), model.disturbance());
  }
  for (int i = 0; i < model.recording_bias_size(); ++i) {
    result.recording_bias.push_back(
        ReadRecordingBias(reader.Item("recording_bias", i), model.recording_bias(i)));
  }
  result.effects = ReadEffects(reader, model);
  result.simulation = ReadSimulationParameters(reader, model);
  if (model.has_joint()) result.joint = ReadJoint(reader.Optional("joint"));
  result.window = ReadWindow(reader.Optional("window"), model.window());
  result.refusals = ReadRefusals(model);
  result.provenance = ReadProvenance(reader.Optional("provenance"), model.provenance());
  return result;
}

}  // namespace

proto::Coefficient ToProto(const Coefficient& coefficient) {
  proto::Coefficient message;
  Write(coefficient, message);
  return message;
}

proto::Refusal ToProto(const Refusal& refusal) {
  proto::Refusal message;
  Write(refusal, message);
  return message;
}

proto::Model ToProto(const Identification& identification) {
  proto::Model model;
  model.set_vehicle_id(identification.vehicle_id);
  model.set_structure(EnumCast<proto::Structure>(identification.structure));
  model.set_parameterization(EnumCast<proto::Parameterization>(identification.parameterization));
  model.mutable_dead_zone()->set_forward(identification.dead_zone.forward);
  model.mutable_dead_zone()->set_reverse(identification.dead_zone.reverse);
  model.set_estimator(EnumCast<proto::Estimator>(identification.estimator));
  model.set_sampling_period_s(identification.sampling_period_s);
  for (const Coefficient& coefficient : identification.coefficients) {
    Write(coefficient, *model.add_coefficients());
  }
  const Eigen::MatrixXd& covariance = identification.covariance;
  for (Eigen::Index row = 0; row < covariance.rows(); ++row) {
    for (Eigen::Index column = 0; column < covariance.cols(); ++column) {
      model.add_covariance(covariance(row, column));
    }
  }
  if (identification.thruster_time_constant) {
    Write(*identification.thruster_time_constant, *model.mutable_thruster_time_constant_s());
  }
  const Eigen::VectorXd& with_tau = identification.time_constant_covariance;
  model.mutable_thruster_time_constant_covariance()->Add(with_tau.begin(), with_tau.end());
  if (identification.disturbance) Write(*identification.disturbance, *model.mutable_disturbance());
  for (const RecordingBias& recording_bias : identification.recording_bias) {
    Write(recording_bias, *model.add_recording_bias());
  }
  WriteEffects(identification.effects, model);
  if (identification.joint) WriteJoint(identification, *model.mutable_joint());
  model.mutable_simulation()->Add(identification.simulation.begin(),
                                  identification.simulation.end());
  Write(identification.window, *model.mutable_window());
  for (const Refusal& refusal : identification.refusals) Write(refusal, *model.add_refusals());
  Write(identification.provenance, *model.mutable_provenance());
  WriteIdentifiability(identification, model);
  return model;
}

Decoded<Identification> IdentificationOf(const proto::Model& model, const std::string& file) {
  const FieldSource source{file, FieldSource::Names::kJson, nullptr};
  std::optional<CodecError> fault;
  FieldReader reader(model, source, fault);
  Identification identification = ReadModel(reader, model);
  if (!fault) CheckOrder(reader, identification.coefficients, identification.parameterization);
  if (!fault) ReadIdentifiability(reader, model, identification);
  if (fault) return tl::unexpected(*fault);
  return identification;
}

std::string PrintModelJson(const Identification& identification) {
  return PrintJsonMessage(ToProto(identification));
}

Decoded<Identification> ParseModelJson(std::string_view text, const std::string& file) {
  proto::Model model;
  if (const auto fault = ParseJsonMessage(text, file, model)) return tl::unexpected(*fault);
  return IdentificationOf(model, file);
}

}  // namespace telltale
