#include "telltale/idl/codec/wire/wire.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <initializer_list>
#include <limits>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/effects/effect.hpp"
#include "telltale/idl/codec/field_reader.hpp"
#include "telltale/idl/codec/json/report.hpp"
#include "telltale/idl/codec/vehicle_file.hpp"

namespace telltale {
namespace {

constexpr std::size_t kIdentifierBound = 64;

// ---- core -> wire -------------------------------------------------------------------------------

template <std::size_t n>
void Put(char (&target)[n], std::string_view text) {
  Require(text.size() < n, "an identifier that fits its bounded string");
  std::copy(text.begin(), text.end(), target);
  target[text.size()] = '\0';
}

void Put(char*& target, std::string_view text) {
  target = dds_string_alloc(text.size());
  std::copy(text.begin(), text.end(), target);
  target[text.size()] = '\0';
}

void PutIdentifier(auto& target, std::string_view text) {
  Require(IsVehicleId(text), "a vehicle or correlation id of letters, digits, '.', '_' and '-'");
  Put(target, text);
}

/// Gives a wire sequence `items.size()` elements and fills each with `fill(element, item)`.
template <class Sequence, class Items, class Fill>
void PutSequence(Sequence& sequence, const Items& items, Fill fill) {
  if (items.size() == 0) return;
  using Element = std::remove_pointer_t<decltype(sequence._buffer)>;
  sequence._buffer = static_cast<Element*>(dds_alloc(items.size() * sizeof(Element)));
  sequence._length = sequence._maximum = static_cast<std::uint32_t>(items.size());
  sequence._release = true;
  Element* element = sequence._buffer;
  for (const auto& item : items) fill(*element++, item);
}

void Fill(telltale_wire_Refusal& wire, const Refusal& refusal) {
  Put(wire.subject, refusal.subject);
  Put(wire.reason, refusal.reason);
  Put(wire.advice, refusal.advice);
}

void Fill(telltale_wire_RejectCount& wire, const RejectEntry& entry) {
  Put(wire.channel, entry.channel);
  Put(wire.reason, entry.reason);
  wire.count = entry.count;
}

void Fill(telltale_wire_Coefficient& wire, const Coefficient& coefficient) {
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

void Fill(telltale_wire_CoefficientChange& wire, const CoefficientChange& change) {
  Put(wire.equation, Name(change.equation));
  Put(wire.regressor, change.regressor);
  Put(wire.symbol, change.symbol);
  wire.difference = change.difference;
  wire.standard_error = change.standard_error;
  wire.p_value = change.p_value;
}

void Fill(telltale_wire_IndicativeCoefficient& wire, const IndicativeCoefficient& coefficient) {
  Put(wire.equation, Name(coefficient.equation));
  Put(wire.regressor, coefficient.regressor);
  Put(wire.symbol, coefficient.symbol);
  wire.estimate = coefficient.estimate;
  wire.standard_error = coefficient.standard_error;
  Put(wire.unit, coefficient.unit);
}

void Fill(telltale_wire_JointBounds& wire, const JointBounds& joint) {
  wire.covariance_factor = joint.covariance_factor;
  wire.degrees_of_freedom = joint.degrees_of_freedom;
}

void Fill(telltale_wire_RecordingBias& wire, const RecordingBias& recording_bias);
void Fill(telltale_wire_ModelChange& wire, const ModelChange& change);
void Fill(telltale_wire_AddedEffect& wire, const AddedEffect& added);

void Fill(telltale_wire_ExpectedBounds& wire, const ExpectedBounds& expected) {
  Put(wire.equation, Name(expected.equation));
  Put(wire.regressor, expected.regressor);
  Put(wire.unit, expected.unit);
  wire.estimate = expected.estimate;
  wire.half_width = expected.half_width;
  wire.expected_half_width = expected.expected_half_width;
}

void Fill(telltale_wire_ManoeuvreAdvice& wire, const ManoeuvreAdvice& advice);

void Fill(telltale_wire_CoefficientCoverage& wire, const CoefficientCoverage& coverage) {
  wire = {coverage.tally.held, coverage.tally.of, coverage.bias};
}

void Fill(telltale_wire_CoverageCheck& wire, const CoverageCheck& coverage_check);

void Fill(telltale_wire_Model& wire, const PublishedModel& model);

constexpr auto kFill = [](auto& wire, const auto& item) { Fill(wire, item); };

constexpr auto kCopy = [](double& element, double value) { element = value; };

void Fill(telltale_wire_ManoeuvreAdvice& wire, const ManoeuvreAdvice& advice) {
  Put(wire.manoeuvre, advice.manoeuvre);
  Put(wire.how, advice.how);
  wire.duration_s = advice.duration_s;
  wire.expected_nats = advice.expected_nats;
  PutSequence(wire.expected, advice.expected, kFill);
}

void Fill(telltale_wire_CoverageCheck& wire, const CoverageCheck& coverage_check) {
  wire.replicates_requested = coverage_check.replicates_requested;
  wire.replicates_identified = coverage_check.replicates_identified;
  wire.seed = coverage_check.seed;
  wire.level = coverage_check.level;
  PutSequence(wire.coefficients, coverage_check.coefficients, kFill);
  if (const auto& lag = coverage_check.thruster_time_constant) {
    PutSequence(wire.thruster_time_constant, std::initializer_list<CoefficientCoverage>{*lag},
                kFill);
  }
  wire.joint_held = coverage_check.joint.held;
  wire.joint_total = coverage_check.joint.of;
  wire.mean_coverage = coverage_check.mean_coverage;
  wire.mean_coverage_error = coverage_check.mean_coverage_error;
  wire.truth_is_reported_model = coverage_check.truth_is_reported_model;
}

/// Regressors go by name: their places depend on the parameterization.
void Fill(telltale_wire_Excitation& wire, const ExcitationSummary& summary,
          Parameterization parameterization) {
  const auto regressors = Regressors(summary.equation, parameterization);
  Put(wire.equation, Name(summary.equation));
  wire.condition = summary.condition;
  PutSequence(wire.variance_inflation, summary.variance_inflation, kCopy);
  PutSequence(wire.least_separable, summary.least_separable,
              [&](telltale_wire_CombinationTerm& term, const CombinationTerm& item) {
                Put(term.regressor, regressors[item.regressor].name);
                term.weight = item.weight;
              });
  wire.rows = summary.rows;
  wire.effective_rows = summary.effective_rows;
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

void Fill(telltale_wire_RecordingBias& wire, const RecordingBias& recording_bias) {
  wire.start_s = recording_bias.start_s;
  wire.end_s = recording_bias.end_s;
  PutSequence(wire.coefficients, recording_bias.coefficients, kFill);
}

void Fill(telltale_wire_ModelChange& wire, const ModelChange& change) {
  wire.revision = change.revision;
  Put(wire.verdict, Name(change.verdict));
  wire.p_value = change.p_value;
  wire.statistic = change.statistic;
  wire.degrees_of_freedom = change.degrees_of_freedom;
  PutSequence(wire.coefficients, change.coefficients, kFill);
  Put(wire.reason, change.reason);
}

void Fill(telltale_wire_AddedEffect& wire, const AddedEffect& added) {
  Put(wire.effect, added.effect);
  PutSequence(wire.values, added.values, kCopy);
}

void Fill(telltale_wire_Model& wire, const PublishedModel& model) {
  const Identification& identification = model.identification;
  PutIdentifier(wire.vehicle_id, identification.vehicle_id);
  wire.revision = model.revision;
  wire.published_unix_s = model.published_unix_s;
  Put(wire.structure, Name(identification.structure));
  Put(wire.parameterization, Name(identification.parameterization));
  Put(wire.estimator, Name(identification.estimator));
  wire.sampling_period_s = identification.sampling_period_s;
  PutSequence(wire.coefficients, identification.coefficients, kFill);
  PutSequence(wire.covariance, RowMajor(identification.covariance), kCopy);
  if (const auto& constant = identification.thruster_time_constant) {
    PutSequence(wire.thruster_time_constant, std::initializer_list<Coefficient>{*constant}, kFill);
  }
  PutSequence(wire.thruster_time_constant_covariance, identification.time_constant_covariance,
              kCopy);
  wire.window_start_s = identification.window.start_s;
  wire.window_end_s = identification.window.end_s;
  wire.window_samples = identification.window.samples;
  wire.window_segments = identification.window.segments;
  wire.window_slices = identification.window.slices;
  PutSequence(wire.rejected, RejectEntries(identification.window.rejected), kFill);
  PutSequence(wire.refusals, identification.refusals, kFill);
  const Provenance& provenance = identification.provenance;
  Put(wire.preset, provenance.preset);
  Put(wire.bounds_basis, provenance.bounds_basis);
  wire.bootstrap_replicates = provenance.bootstrap_replicates;
  wire.bootstrap_failures = provenance.bootstrap_failures;
  wire.seed = provenance.seed;
  Put(wire.software_version, provenance.software_version);
  wire.dead_zone_forward = identification.dead_zone.forward;
  wire.dead_zone_reverse = identification.dead_zone.reverse;
  wire.parametric_replicates = provenance.parametric_replicates;
  wire.parametric_replicate_failures = provenance.parametric_replicate_failures;
  Put(wire.estimator_choice, provenance.estimator_choice);
  wire.misspecification = provenance.misspecification;
  if (const auto& disturbance = identification.disturbance) {
    PutSequence(wire.disturbance_sigma, disturbance->sigma, kCopy);
    PutSequence(wire.disturbance_time_constant_s, disturbance->time_constant_s, kCopy);
    wire.gnss_drift_m = disturbance->gnss_drift_m;
  }
  PutSequence(wire.recording_bias, identification.recording_bias, kFill);
  wire.clusters = provenance.clusters;
  if (const auto& change = provenance.change) {
    PutSequence(wire.change, std::initializer_list<ModelChange>{*change}, kFill);
  }
  PutSequence(wire.excitation, identification.excitation,
              [&](telltale_wire_Excitation& element, const ExcitationSummary& summary) {
                Fill(element, summary, identification.parameterization);
              });
  PutSequence(wire.advice, identification.advice, kFill);
  if (const auto& coverage_check = identification.coverage_check) {
    PutSequence(wire.coverage_check, std::initializer_list<CoverageCheck>{*coverage_check}, kFill);
  }
  PutSequence(wire.effects, identification.effects, kFill);
  if (const auto& joint = identification.joint) {
    PutSequence(wire.joint, std::initializer_list<JointBounds>{*joint}, kFill);
    wire.joint._buffer[0].squared_radius = SquaredRadius(identification).value_or(0.0);
  }
  PutSequence(wire.simulation, identification.simulation, kCopy);
}

void Fill(telltale_wire_Diagnosis& wire, const PublishedDiagnosis& published) {
  PutIdentifier(wire.vehicle_id, published.diagnosis.vehicle_id);
  wire.model_revision = published.model_revision;
  wire.published_unix_s = published.published_unix_s;
  Put(wire.verdict, Name(published.diagnosis.verdict));
  Put(wire.sentence, published.diagnosis.sentence);
  Put(wire.report, PrintReportJson(published.diagnosis));
}

void FillProgress(auto& wire, const ExchangeProgress& progress) {
  PutIdentifier(wire.correlation_id, progress.correlation_id);
  PutIdentifier(wire.vehicle_id, progress.vehicle_id);
  Put(wire.stage, progress.stage);
  wire.fraction = progress.fraction;
}

void FillReply(auto& wire, const ExchangeReply& reply) {
  PutIdentifier(wire.correlation_id, reply.correlation_id);
  PutIdentifier(wire.vehicle_id, reply.vehicle_id);
  Put(wire.outcome, Name(reply.outcome));
  Put(wire.message, reply.message);
  PutSequence(wire.refusals, reply.refusals, kFill);
  wire.elapsed_s = reply.elapsed_s;
}

// ---- wire -> core -------------------------------------------------------------------------------

/// Unwinds the decoding of a message at its first fault; never leaves this file.
struct Malformed {
  CodecError error;
};

[[noreturn]] void Reject(std::string field, std::string value, std::string allowed) {
  throw Malformed{{std::move(field), std::move(value), std::move(allowed)}};
}

template <class Read>
auto Guarded(Read read) -> Decoded<decltype(read())> {
  try {
    return read();
  } catch (Malformed& malformed) {
    return tl::unexpected(std::move(malformed.error));
  }
}

/// What a bounded string holds up to its terminator, or to its end where there is none.
template <std::size_t n>
std::string_view View(const char (&text)[n]) {
  return {text, strnlen(text, n)};
}

/// A string that an older writer did not send is null.
std::string_view View(const char* text) {
  return text == nullptr ? std::string_view() : std::string_view(text);
}

CodecError IdentifierError(std::string field, std::string_view value) {
  std::string shown;
  for (const char c : value.substr(0, kIdentifierBound)) {
    shown += c >= ' ' && c <= '~' ? c : '?';
  }
  if (value.size() > kIdentifierBound) shown += "... (too long or not terminated)";
  return {std::move(field), std::move(shown), std::string(kVehicleIdAllowed)};
}

std::string ReadIdentifier(std::string field, const auto& text) {
  const std::string_view view = View(text);
  if (!IsVehicleId(view)) throw Malformed{IdentifierError(std::move(field), view)};
  return std::string(view);
}

std::string Text(double value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.begin(), buffer.end(), value).ptr;
  return {buffer.begin(), end};
}

double ReadWithin(std::string field, double value, double lowest, double highest) {
  if (value >= lowest && value <= highest) return value;
  Reject(std::move(field), Text(value), "[" + Text(lowest) + ", " + Text(highest) + "]");
}

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The enumerator of that name among `allowed`.
template <class Enum>
Enum ReadName(std::string field, std::string_view name, std::initializer_list<Enum> allowed) {
  for (const Enum candidate : allowed) {
    if (Name(candidate) == name) return candidate;
  }
  std::string names;
  for (const Enum candidate : allowed) {
    names.append(names.empty() ? "one of " : ", ").append(Name(candidate));
  }
  Reject(std::move(field), std::string(name), std::move(names));
}

/// As ReadName, an empty name being the unknown enumerator.
template <class Enum>
Enum ReadOptionalName(std::string field, std::string_view name,
                      std::initializer_list<Enum> allowed) {
  return name.empty() ? Enum::kUnknown : ReadName(std::move(field), name, allowed);
}

constexpr std::initializer_list<Equation> kAllEquations = {Equation::kSurge, Equation::kSway,
                                                           Equation::kYaw};
constexpr std::initializer_list<Structure> kStructures = {Structure::kStaticQuadratic,
                                                          Structure::kFirstOrderDynamic};
constexpr std::initializer_list<Parameterization> kParameterizations = {
    Parameterization::kPropeller, Parameterization::kPaper};
constexpr std::initializer_list<Estimator> kEstimators = {Estimator::kOneStep, Estimator::kWeakIv,
                                                          Estimator::kOutputError};
constexpr std::initializer_list<Resampling> kResamplings = {
    Resampling::kSlices, Resampling::kMovingBlocks, Resampling::kParametric};
constexpr std::initializer_list<IntervalMethod> kIntervalMethods = {
    IntervalMethod::kPercentile, IntervalMethod::kStudentized, IntervalMethod::kBca};
constexpr std::initializer_list<RecordingBiasModel> kRecordingBiasModels = {
    RecordingBiasModel::kShared, RecordingBiasModel::kPerRecording,
    RecordingBiasModel::kPerRecordingNorthEast};
constexpr std::initializer_list<DeadZoneSource> kDeadZoneSources = {DeadZoneSource::kGiven,
                                                                    DeadZoneSource::kIdentified};
constexpr std::initializer_list<CoefficientStatus> kStatuses = {
    CoefficientStatus::kEstimated, CoefficientStatus::kNotExcited, CoefficientStatus::kCollinear};
constexpr std::initializer_list<ChangeVerdict> kVerdicts = {
    ChangeVerdict::kNoSignificantChange, ChangeVerdict::kChanged, ChangeVerdict::kInconclusive};
constexpr std::initializer_list<Preset> kPresets = {Preset::kRobust, Preset::kPaper};
constexpr std::initializer_list<ReplyOutcome> kReplyOutcomes = {
    ReplyOutcome::kPublished, ReplyOutcome::kRefused, ReplyOutcome::kFailed};

template <class Sequence, class Read>
auto ReadSequence(const std::string& field, const Sequence& sequence, Read read) {
  std::vector<decltype(read(field, sequence._buffer[0]))> items;
  items.reserve(sequence._length);
  for (std::uint32_t i = 0; i < sequence._length; ++i) {
    items.push_back(read(field + "[" + std::to_string(i) + "]", sequence._buffer[i]));
  }
  return items;
}

Refusal ReadRefusal(const std::string&, const telltale_wire_Refusal& wire) {
  return {std::string(View(wire.subject)), std::string(View(wire.reason)),
          std::string(View(wire.advice))};
}

RejectEntry ReadRejectEntry(const std::string&, const telltale_wire_RejectCount& wire) {
  return {std::string(View(wire.channel)), std::string(View(wire.reason)), wire.count};
}

RejectCounts ReadRejectCounts(const dds_sequence_telltale_wire_RejectCount& sequence) {
  RejectCounts counts;
  for (std::uint32_t i = 0; i < sequence._length; ++i) {
    const auto& wire = sequence._buffer[i];
    const std::string field = "rejected[" + std::to_string(i) + "]";
    const auto channel = ReadName(field + ".channel", View(wire.channel),
                                  {Channel::kGnss, Channel::kHeading, Channel::kThrusters});
    const auto reason =
        ReadName(field + ".reason", View(wire.reason),
                 {RejectReason::kNotFinite, RejectReason::kOutOfRange, RejectReason::kDuplicate,
                  RejectReason::kOutOfOrder, RejectReason::kClockJump, RejectReason::kStuckSensor});
    counts.Count(channel, reason, wire.count);
  }
  return counts;
}

Coefficient ReadCoefficient(const std::string& field, const telltale_wire_Coefficient& wire) {
  Coefficient coefficient;
  coefficient.equation = ReadOptionalName(
      field + ".equation",
      View(wire.equation) == Name(Equation::kUnknown) ? "" : View(wire.equation), kAllEquations);
  coefficient.regressor = View(wire.regressor);
  coefficient.symbol = View(wire.symbol);
  coefficient.estimate = ReadWithin(field + ".estimate", wire.estimate, -kLargest, kLargest);
  coefficient.standard_error =
      ReadWithin(field + ".standard_error", wire.standard_error, 0.0, kInfinity);
  coefficient.interval.level = ReadWithin(field + ".bounds.level", wire.bounds.level, 0.0, 1.0);
  coefficient.interval.lower =
      ReadWithin(field + ".bounds.lower", wire.bounds.lower, -kInfinity, kInfinity);
  coefficient.interval.upper =
      ReadWithin(field + ".bounds.upper", wire.bounds.upper, wire.bounds.lower, kInfinity);
  coefficient.unit = View(wire.unit);
  coefficient.status = ReadName(field + ".status", View(wire.status), kStatuses);
  return coefficient;
}

Eigen::MatrixXd ReadCovariance(const dds_sequence_double& wire, std::size_t coefficients) {
  if (wire._length != coefficients * coefficients) {
    Reject(
        "covariance", std::to_string(wire._length) + " numbers",
        std::to_string(coefficients * coefficients) + ", the square of the number of coefficients");
  }
  const auto n = static_cast<Eigen::Index>(coefficients);
  Eigen::MatrixXd covariance(n, n);
  for (Eigen::Index row = 0; row < n; ++row) {
    for (Eigen::Index column = 0; column < n; ++column) {
      covariance(row, column) =
          ReadWithin("covariance", wire._buffer[row * n + column], -kInfinity, kInfinity);
    }
  }
  return covariance;
}

DeadZone ReadDeadZone(double forward, double reverse) {
  return {ReadWithin("dead_zone_forward", forward, 0.0, kWidestDeadZone),
          ReadWithin("dead_zone_reverse", reverse, -kWidestDeadZone, 0.0)};
}

/// There for the dynamic structure and for nothing else.
std::optional<Coefficient> ReadTimeConstant(const telltale_wire_Model& wire, Structure structure) {
  const bool dynamic = structure == Structure::kFirstOrderDynamic;
  const auto& constants = wire.thruster_time_constant;
  if (constants._length != (dynamic ? 1u : 0u)) {
    Reject("thruster_time_constant", std::to_string(constants._length) + " items",
           "one for FIRST_ORDER_DYNAMIC, none otherwise");
  }
  if (!dynamic) return std::nullopt;
  const std::string field = "thruster_time_constant[0]";
  ReadWithin(field + ".estimate", constants._buffer[0].estimate, std::numeric_limits<double>::min(),
             kLargest);
  return ReadCoefficient(field, constants._buffer[0]);
}

std::vector<double> ReadNumbers(const char* field, const dds_sequence_double& wire) {
  std::vector<double> numbers(wire._length);
  for (std::uint32_t i = 0; i < wire._length; ++i) {
    numbers[i] = ReadWithin(field, wire._buffer[i], -kLargest, kLargest);
  }
  return numbers;
}

/// None stands for zero: older writers know of none.
Eigen::VectorXd ReadTimeConstantCovariance(const dds_sequence_double& wire, Structure structure,
                                           std::size_t coefficients) {
  const bool dynamic = structure == Structure::kFirstOrderDynamic;
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

std::vector<double> ReadSimulationParameters(const dds_sequence_double& wire,
                                             std::size_t coefficients) {
  if (wire._length != 0 && wire._length != coefficients) {
    Reject("simulation", std::to_string(wire._length) + " numbers",
           std::to_string(coefficients) + ", one for each coefficient, or none");
  }
  return ReadNumbers("simulation", wire);
}

/// (0, any]: the smallest time constant that is one.
constexpr double kShortestS = std::numeric_limits<double>::min();

Eigen::Vector3d ReadAxes(const char* field, const dds_sequence_double& values, double least) {
  if (values._length != 3) {
    Reject(field, std::to_string(values._length) + " numbers", "3, one for each axis, or none");
  }
  Eigen::Vector3d axes;
  for (std::uint32_t i = 0; i < 3; ++i) {
    axes[i] = ReadWithin(field, values._buffer[i], least, kLargest);
  }
  return axes;
}

std::optional<Disturbance> ReadDisturbance(const dds_sequence_double& sigma,
                                           const dds_sequence_double& time_constant_s,
                                           double gnss_drift_m) {
  if (sigma._length == 0 && time_constant_s._length == 0) return std::nullopt;
  return Disturbance{ReadAxes("disturbance_sigma", sigma, 0.0),
                     ReadAxes("disturbance_time_constant_s", time_constant_s, kShortestS),
                     ReadWithin("gnss_drift_m", gnss_drift_m, 0.0, kLargest)};
}

IndicativeCoefficient ReadIndicative(const std::string& field,
                                     const telltale_wire_IndicativeCoefficient& wire) {
  return {ReadName(field + ".equation", View(wire.equation), kAllEquations),
          std::string(View(wire.regressor)),
          std::string(View(wire.symbol)),
          ReadWithin(field + ".estimate", wire.estimate, -kLargest, kLargest),
          ReadWithin(field + ".standard_error", wire.standard_error, 0.0, kLargest),
          std::string(View(wire.unit))};
}

RecordingBias ReadRecordingBias(const std::string& field, const telltale_wire_RecordingBias& wire) {
  RecordingBias recording_bias;
  recording_bias.start_s = ReadWithin(field + ".start_s", wire.start_s, -kLargest, kLargest);
  recording_bias.end_s = ReadWithin(field + ".end_s", wire.end_s, wire.start_s, kLargest);
  recording_bias.coefficients =
      ReadSequence(field + ".coefficients", wire.coefficients, ReadCoefficient);
  return recording_bias;
}

CoefficientChange ReadCoefficientChange(const std::string& field,
                                        const telltale_wire_CoefficientChange& wire) {
  return {ReadName(field + ".equation", View(wire.equation),
                   {Equation::kUnknown, Equation::kSurge, Equation::kSway, Equation::kYaw}),
          std::string(View(wire.regressor)),
          std::string(View(wire.symbol)),
          ReadWithin(field + ".difference", wire.difference, -kLargest, kLargest),
          ReadWithin(field + ".standard_error", wire.standard_error,
                     std::numeric_limits<double>::min(), kLargest),
          ReadWithin(field + ".p_value", wire.p_value, 0.0, 1.0)};
}

ModelChange ReadModelChange(const std::string& field, const telltale_wire_ModelChange& wire) {
  ModelChange change;
  change.revision = wire.revision;
  change.verdict = ReadName(field + ".verdict", View(wire.verdict), kVerdicts);
  change.p_value = ReadWithin(field + ".p_value", wire.p_value, 0.0, 1.0);
  change.statistic = ReadWithin(field + ".statistic", wire.statistic, 0.0, kLargest);
  change.degrees_of_freedom = wire.degrees_of_freedom;
  change.coefficients =
      ReadSequence(field + ".coefficients", wire.coefficients, ReadCoefficientChange);
  change.reason = View(wire.reason);
  return change;
}

/// None from older writers and for a vehicle's first model.
std::optional<ModelChange> ReadChange(const dds_sequence_telltale_wire_ModelChange& wire) {
  if (wire._length > 1) Reject("change", std::to_string(wire._length) + " items", "none or one");
  if (wire._length == 0) return std::nullopt;
  return ReadModelChange("change[0]", wire._buffer[0]);
}

ExcitationSummary ReadExcitation(const std::string& field, const telltale_wire_Excitation& wire,
                                 Parameterization parameterization) {
  ExcitationSummary summary;
  summary.equation = ReadName(field + ".equation", View(wire.equation), kAllEquations);
  const auto regressors = Regressors(summary.equation, parameterization);
  summary.condition = ReadWithin(field + ".condition", wire.condition, 1.0, kInfinity);
  if (wire.variance_inflation._length != regressors.size()) {
    Reject(field + ".variance_inflation",
           std::to_string(wire.variance_inflation._length) + " numbers",
           std::to_string(regressors.size()) + ", one for each regressor");
  }
  summary.variance_inflation = ReadSequence(field + ".variance_inflation", wire.variance_inflation,
                                            [](const std::string& name, double factor) {
                                              return ReadWithin(name, factor, 0.0, kInfinity);
                                            });
  summary.least_separable =
      ReadSequence(field + ".least_separable", wire.least_separable,
                   [&](const std::string& name, const telltale_wire_CombinationTerm& term) {
                     const auto found = std::find_if(
                         regressors.begin(), regressors.end(),
                         [&](const Regressor& r) { return r.name == View(term.regressor); });
                     if (found == regressors.end()) {
                       Reject(name + ".regressor", std::string(View(term.regressor)),
                              "a regressor of this equation");
                     }
                     return CombinationTerm{static_cast<std::size_t>(found - regressors.begin()),
                                            ReadWithin(name + ".weight", term.weight, -1.0, 1.0)};
                   });
  summary.rows = wire.rows;
  summary.effective_rows =
      ReadWithin(field + ".effective_rows", wire.effective_rows, 0.0, kLargest);
  return summary;
}

ExpectedBounds ReadExpectedBounds(const std::string& field,
                                  const telltale_wire_ExpectedBounds& wire) {
  ExpectedBounds expected;
  expected.equation = ReadName(field + ".equation", View(wire.equation), kAllEquations);
  expected.regressor = View(wire.regressor);
  expected.unit = View(wire.unit);
  expected.estimate = ReadWithin(field + ".estimate", wire.estimate, -kLargest, kLargest);
  expected.half_width = ReadWithin(field + ".half_width", wire.half_width, 0.0, kInfinity);
  expected.expected_half_width =
      ReadWithin(field + ".expected_half_width", wire.expected_half_width, 0.0, kInfinity);
  return expected;
}

ManoeuvreAdvice ReadAdvice(const std::string& field, const telltale_wire_ManoeuvreAdvice& wire) {
  ManoeuvreAdvice advice;
  advice.manoeuvre = View(wire.manoeuvre);
  advice.how = View(wire.how);
  advice.duration_s = ReadWithin(field + ".duration_s", wire.duration_s, 0.0, kLargest);
  advice.expected_nats =
      ReadWithin(field + ".expected_nats", wire.expected_nats, -kLargest, kLargest);
  advice.expected = ReadSequence(field + ".expected", wire.expected, ReadExpectedBounds);
  return advice;
}

Tally ReadTally(const std::string& field, std::uint64_t held, std::uint64_t total) {
  if (held > total) {
    Reject(field, std::to_string(held), "not above the total of " + std::to_string(total));
  }
  return {held, total};
}

CoefficientCoverage ReadCoverage(const std::string& field,
                                 const telltale_wire_CoefficientCoverage& wire) {
  return {ReadTally(field + ".held", wire.held, wire.total),
          ReadWithin(field + ".bias", wire.bias, -kLargest, kLargest)};
}

std::optional<CoverageCheck> ReadCoverageCheck(
    const dds_sequence_telltale_wire_CoverageCheck& coverage_checks,
    const Identification& identification) {
  if (coverage_checks._length == 0) return std::nullopt;
  const std::string field = "coverage_check[0]";
  const telltale_wire_CoverageCheck& wire = coverage_checks._buffer[0];
  CoverageCheck coverage_check;
  const Tally answered = ReadTally(field + ".replicates_identified", wire.replicates_identified,
                                   wire.replicates_requested);
  coverage_check.replicates_requested = answered.of;
  coverage_check.replicates_identified = answered.held;
  coverage_check.seed = wire.seed;
  coverage_check.level = ReadWithin(field + ".level", wire.level, 0.0, 1.0);
  coverage_check.coefficients =
      ReadSequence(field + ".coefficients", wire.coefficients, ReadCoverage);
  if (coverage_check.coefficients.size() != identification.coefficients.size()) {
    Reject(field + ".coefficients", std::to_string(coverage_check.coefficients.size()) + " items",
           std::to_string(identification.coefficients.size()) + ", one for each coefficient");
  }
  if (wire.thruster_time_constant._length > 0) {
    coverage_check.thruster_time_constant =
        ReadCoverage(field + ".thruster_time_constant", wire.thruster_time_constant._buffer[0]);
  }
  coverage_check.joint = ReadTally(field + ".joint_held", wire.joint_held, wire.joint_total);
  coverage_check.mean_coverage = ReadWithin(field + ".mean_coverage", wire.mean_coverage, 0.0, 1.0);
  coverage_check.mean_coverage_error =
      ReadWithin(field + ".mean_coverage_error", wire.mean_coverage_error, 0.0, kLargest);
  coverage_check.truth_is_reported_model = wire.truth_is_reported_model;
  return coverage_check;
}

AddedEffect ReadAddedEffect(const std::string& field, const telltale_wire_AddedEffect& wire) {
  const std::string name(View(wire.effect));
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
                                      wire.values._buffer[i], parameters[i].lower,
                                      parameters[i].upper));
  }
  return added;
}

/// The radius follows from the rest.
std::optional<JointBounds> ReadJoint(const dds_sequence_telltale_wire_JointBounds& wire) {
  if (wire._length == 0) return std::nullopt;
  const telltale_wire_JointBounds& joint = wire._buffer[0];
  return JointBounds{
      ReadWithin("joint[0].covariance_factor", joint.covariance_factor,
                 std::numeric_limits<double>::min(), kLargest),
      ReadWithin("joint[0].degrees_of_freedom", joint.degrees_of_freedom, 1.0, kLargest)};
}

PublishedModel ReadModel(const telltale_wire_Model& wire) {
  PublishedModel model;
  model.revision = wire.revision;
  model.published_unix_s = ReadWithin("published_unix_s", wire.published_unix_s, 0.0, kLargest);
  Identification& identification = model.identification;
  identification.vehicle_id = ReadIdentifier("vehicle_id", wire.vehicle_id);
  identification.structure = ReadName("structure", View(wire.structure), kStructures);
  identification.parameterization =
      ReadName("parameterization", View(wire.parameterization), kParameterizations);
  identification.estimator = ReadName("estimator", View(wire.estimator), kEstimators);
  identification.sampling_period_s =
      ReadWithin("sampling_period_s", wire.sampling_period_s, 1e-6, 1e6);
  identification.coefficients = ReadSequence("coefficients", wire.coefficients, ReadCoefficient);
  identification.covariance = ReadCovariance(wire.covariance, identification.coefficients.size());
  identification.thruster_time_constant = ReadTimeConstant(wire, identification.structure);
  identification.time_constant_covariance =
      ReadTimeConstantCovariance(wire.thruster_time_constant_covariance, identification.structure,
                                 identification.coefficients.size());
  identification.dead_zone = ReadDeadZone(wire.dead_zone_forward, wire.dead_zone_reverse);
  identification.window.start_s =
      ReadWithin("window_start_s", wire.window_start_s, -kLargest, kLargest);
  identification.window.end_s =
      ReadWithin("window_end_s", wire.window_end_s, wire.window_start_s, kLargest);
  identification.window.samples = wire.window_samples;
  identification.window.segments = wire.window_segments;
  identification.window.slices = wire.window_slices;
  identification.window.rejected = ReadRejectCounts(wire.rejected);
  identification.refusals = ReadSequence("refusals", wire.refusals, ReadRefusal);
  identification.provenance.preset = View(wire.preset);
  identification.provenance.bounds_basis = View(wire.bounds_basis);
  identification.provenance.bootstrap_replicates = wire.bootstrap_replicates;
  identification.provenance.bootstrap_failures = wire.bootstrap_failures;
  identification.provenance.seed = wire.seed;
  identification.provenance.software_version = View(wire.software_version);
  identification.provenance.parametric_replicates = wire.parametric_replicates;
  identification.provenance.parametric_replicate_failures = wire.parametric_replicate_failures;
  identification.provenance.estimator_choice = View(wire.estimator_choice);
  identification.provenance.misspecification =
      ReadWithin("misspecification", wire.misspecification, 0.0, kLargest);
  identification.disturbance =
      ReadDisturbance(wire.disturbance_sigma, wire.disturbance_time_constant_s, wire.gnss_drift_m);
  identification.recording_bias =
      ReadSequence("recording_bias", wire.recording_bias, ReadRecordingBias);
  identification.provenance.clusters = wire.clusters;
  identification.provenance.change = ReadChange(wire.change);
  identification.excitation =
      ReadSequence("excitation", wire.excitation,
                   [&](const std::string& field, const telltale_wire_Excitation& element) {
                     return ReadExcitation(field, element, identification.parameterization);
                   });
  identification.advice = ReadSequence("advice", wire.advice, ReadAdvice);
  identification.coverage_check = ReadCoverageCheck(wire.coverage_check, identification);
  identification.effects = ReadSequence("effects", wire.effects, ReadAddedEffect);
  identification.joint = ReadJoint(wire.joint);
  identification.simulation =
      ReadSimulationParameters(wire.simulation, identification.coefficients.size());
  return model;
}

/// Verdict and sentence stand in the report too, and are for those who read no JSON.
PublishedDiagnosis ReadDiagnosis(const telltale_wire_Diagnosis& wire) {
  PublishedDiagnosis published;
  auto diagnosis = ParseReportJson(View(wire.report));
  if (!diagnosis) throw Malformed{std::move(diagnosis).error()};
  published.diagnosis = *std::move(diagnosis);
  if (ReadIdentifier("vehicle_id", wire.vehicle_id) != published.diagnosis.vehicle_id) {
    Reject("vehicle_id", std::string(View(wire.vehicle_id)),
           "the report's, " + published.diagnosis.vehicle_id);
  }
  published.model_revision = wire.model_revision;
  published.published_unix_s = ReadWithin("published_unix_s", wire.published_unix_s, 0.0, kLargest);
  return published;
}

ExchangeProgress ReadProgress(const auto& wire) {
  return {ReadIdentifier("correlation_id", wire.correlation_id),
          ReadIdentifier("vehicle_id", wire.vehicle_id), std::string(View(wire.stage)),
          ReadWithin("fraction", wire.fraction, 0.0, 1.0)};
}

ExchangeReply ReadReply(const auto& wire) {
  return {ReadIdentifier("correlation_id", wire.correlation_id),
          ReadIdentifier("vehicle_id", wire.vehicle_id),
          ReadName("outcome", View(wire.outcome), kReplyOutcomes),
          std::string(View(wire.message)),
          ReadSequence("refusals", wire.refusals, ReadRefusal),
          ReadWithin("elapsed_s", wire.elapsed_s, 0.0, kLargest)};
}

/// Whether there is an answer to read: one where something was published, else none.
bool HasPublishedItem(const char* field, const auto& answer, const ExchangeReply& reply) {
  const bool published = reply.outcome == ReplyOutcome::kPublished;
  if (answer._length != (published ? 1u : 0u)) {
    Reject(field, std::to_string(answer._length) + " items",
           published ? "one when published" : "none unless published");
  }
  return published;
}

/// None where no effect is likely, and from writers that know of none.
std::optional<Identification> ReadAugmented(const dds_sequence_telltale_wire_Model& wire,
                                            const DiagnoseReply& reply) {
  const std::uint32_t most = reply.diagnosis ? 1 : 0;
  if (wire._length > most) {
    Reject("augmented", std::to_string(wire._length) + " items",
           most > 0 ? "none or one" : "none unless published");
  }
  if (wire._length == 0) return std::nullopt;
  Identification augmented = ReadModel(wire._buffer[0]).identification;
  if (augmented.vehicle_id != reply.vehicle_id) {
    Reject("augmented[0].vehicle_id", augmented.vehicle_id, "the reply's, " + reply.vehicle_id);
  }
  return augmented;
}

/// The common part of the three telemetry types: no exception and no allocation on the way of a
/// sound sample.
template <class Sample, class Wire>
Decoded<Telemetry<Sample>> DecodeTelemetry(const Wire& wire, const Sample& sample) {
  const std::string_view vehicle_id = View(wire.vehicle_id);
  if (!IsVehicleId(vehicle_id)) {
    return tl::unexpected(IdentifierError("vehicle_id", vehicle_id));
  }
  return Telemetry<Sample>{vehicle_id, wire.sequence_number, sample};
}

}  // namespace

telltale_wire_GnssFix Encode(const Telemetry<GnssFix>& fix) {
  telltale_wire_GnssFix wire{};
  PutIdentifier(wire.vehicle_id, fix.vehicle_id);
  wire.sequence_number = fix.sequence_number;
  wire.time_s = fix.sample.time_s;
  wire.latitude_deg = fix.sample.latitude_deg;
  wire.longitude_deg = fix.sample.longitude_deg;
  return wire;
}

telltale_wire_Heading Encode(const Telemetry<HeadingSample>& heading) {
  telltale_wire_Heading wire{};
  PutIdentifier(wire.vehicle_id, heading.vehicle_id);
  wire.sequence_number = heading.sequence_number;
  wire.time_s = heading.sample.time_s;
  wire.heading_deg = heading.sample.heading_deg;
  return wire;
}

telltale_wire_Thrusters Encode(const Telemetry<ThrusterSample>& thrusters) {
  telltale_wire_Thrusters wire{};
  PutIdentifier(wire.vehicle_id, thrusters.vehicle_id);
  wire.sequence_number = thrusters.sequence_number;
  wire.time_s = thrusters.sample.time_s;
  wire.left_us = thrusters.sample.port_us;
  wire.right_us = thrusters.sample.starboard_us;
  return wire;
}

WireSample<telltale_wire_Model> Encode(const PublishedModel& model) {
  WireSample<telltale_wire_Model> wire;
  Fill(*wire, model);
  return wire;
}

WireSample<telltale_wire_IdentifyRequest> Encode(const IdentifyRequest& request) {
  const auto name = [](auto value) {
    return value == decltype(value)::kUnknown ? std::string_view() : Name(value);
  };
  WireSample<telltale_wire_IdentifyRequest> wire;
  PutIdentifier(wire->correlation_id, request.correlation_id);
  PutIdentifier(wire->vehicle_id, request.vehicle_id);
  Put(wire->structure, name(request.structure));
  Put(wire->parameterization, name(request.parameterization));
  Put(wire->estimator, name(request.estimator));
  Put(wire->preset, name(request.preset));
  wire->bootstrap_given = request.bootstrap_replicates.has_value();
  wire->bootstrap_replicates = request.bootstrap_replicates.value_or(0);
  wire->seed = request.seed;
  Put(wire->dead_zone, name(request.dead_zone_source));
  wire->dead_zone_forward = request.dead_zone.forward;
  wire->dead_zone_reverse = request.dead_zone.reverse;
  wire->include_reverse = request.include_reverse;
  Put(wire->resampling, name(request.resampling));
  Put(wire->interval_method, name(request.interval_method));
  wire->coverage_check_replicates = request.coverage_check_replicates;
  Put(wire->recording_bias, name(request.recording_bias));
  return wire;
}

WireSample<telltale_wire_IdentifyProgress> Encode(const IdentifyProgress& progress) {
  WireSample<telltale_wire_IdentifyProgress> wire;
  FillProgress(*wire, progress);
  return wire;
}

WireSample<telltale_wire_IdentifyReply> Encode(const IdentifyReply& reply) {
  WireSample<telltale_wire_IdentifyReply> wire;
  FillReply(*wire, reply);
  if (reply.model) {
    wire->revision = reply.model->revision;
    PutSequence(wire->model, std::initializer_list<PublishedModel>{*reply.model}, kFill);
  }
  return wire;
}

WireSample<telltale_wire_Diagnosis> Encode(const PublishedDiagnosis& diagnosis) {
  WireSample<telltale_wire_Diagnosis> wire;
  Fill(*wire, diagnosis);
  return wire;
}

WireSample<telltale_wire_DiagnoseRequest> Encode(const DiagnoseRequest& request) {
  WireSample<telltale_wire_DiagnoseRequest> wire;
  PutIdentifier(wire->correlation_id, request.correlation_id);
  PutIdentifier(wire->vehicle_id, request.vehicle_id);
  wire->refit = request.refit;
  PutSequence(wire->without, request.without,
              [](char*& element, const std::string& effect) { Put(element, effect); });
  wire->seed = request.seed;
  return wire;
}

WireSample<telltale_wire_DiagnoseProgress> Encode(const DiagnoseProgress& progress) {
  WireSample<telltale_wire_DiagnoseProgress> wire;
  FillProgress(*wire, progress);
  return wire;
}

WireSample<telltale_wire_DiagnoseReply> Encode(const DiagnoseReply& reply) {
  WireSample<telltale_wire_DiagnoseReply> wire;
  FillReply(*wire, reply);
  if (reply.diagnosis) {
    PutSequence(wire->diagnosis, std::initializer_list<PublishedDiagnosis>{*reply.diagnosis},
                [](auto& element, const PublishedDiagnosis& item) { Fill(element, item); });
  }
  if (reply.augmented) {
    PutSequence(wire->augmented, std::initializer_list<PublishedModel>{{*reply.augmented, 0, 0.0}},
                kFill);
  }
  return wire;
}

WireSample<telltale_wire_Quality> Encode(const Quality& quality) {
  WireSample<telltale_wire_Quality> wire;
  if (quality.vehicle_id == kUnattributed) {
    Put(wire->vehicle_id, kUnattributed);
  } else {
    PutIdentifier(wire->vehicle_id, quality.vehicle_id);
  }
  wire->sequence_number = quality.sequence_number;
  wire->window_s = quality.window_s;
  wire->window_fill = quality.window_fill;
  wire->gnss_rate_hz = quality.gnss_rate_hz;
  wire->heading_rate_hz = quality.heading_rate_hz;
  wire->thrusters_rate_hz = quality.thrusters_rate_hz;
  wire->lost = quality.lost;
  wire->accepted = quality.accepted;
  PutSequence(wire->rejected, quality.rejected, kFill);
  wire->has_model = quality.model_revision.has_value();
  wire->model_revision = quality.model_revision.value_or(0);
  wire->model_age_s = quality.model_age_s;
  wire->prediction_error = quality.prediction_error;
  wire->drift = quality.drift;
  PutSequence(wire->indicative, quality.indicative, kFill);
  wire->indicative_rows = quality.indicative_rows;
  Put(wire->proposal, quality.proposal);
  return wire;
}

Decoded<Telemetry<GnssFix>> Decode(const telltale_wire_GnssFix& wire) {
  return DecodeTelemetry(wire, GnssFix{wire.time_s, wire.latitude_deg, wire.longitude_deg});
}

Decoded<Telemetry<HeadingSample>> Decode(const telltale_wire_Heading& wire) {
  return DecodeTelemetry(wire, HeadingSample{wire.time_s, wire.heading_deg});
}

Decoded<Telemetry<ThrusterSample>> Decode(const telltale_wire_Thrusters& wire) {
  return DecodeTelemetry(wire, ThrusterSample{wire.time_s, wire.left_us, wire.right_us});
}

Decoded<PublishedModel> Decode(const telltale_wire_Model& wire) {
  return Guarded([&] { return ReadModel(wire); });
}

Decoded<IdentifyRequest> Decode(const telltale_wire_IdentifyRequest& wire) {
  return Guarded([&] {
    IdentifyRequest request;
    request.correlation_id = ReadIdentifier("correlation_id", wire.correlation_id);
    request.vehicle_id = ReadIdentifier("vehicle_id", wire.vehicle_id);
    request.structure = ReadOptionalName("structure", View(wire.structure), kStructures);
    request.parameterization =
        ReadOptionalName("parameterization", View(wire.parameterization), kParameterizations);
    request.estimator = ReadOptionalName("estimator", View(wire.estimator), kEstimators);
    request.preset = ReadOptionalName("preset", View(wire.preset), kPresets);
    if (wire.bootstrap_given) request.bootstrap_replicates = wire.bootstrap_replicates;
    request.seed = wire.seed;
    request.dead_zone_source =
        ReadOptionalName("dead_zone", View(wire.dead_zone), kDeadZoneSources);
    request.dead_zone = ReadDeadZone(wire.dead_zone_forward, wire.dead_zone_reverse);
    request.include_reverse = wire.include_reverse;
    request.resampling = ReadOptionalName("resampling", View(wire.resampling), kResamplings);
    request.interval_method =
        ReadOptionalName("interval_method", View(wire.interval_method), kIntervalMethods);
    request.coverage_check_replicates = wire.coverage_check_replicates;
    request.recording_bias =
        ReadOptionalName("recording_bias", View(wire.recording_bias), kRecordingBiasModels);
    return request;
  });
}

Decoded<IdentifyProgress> Decode(const telltale_wire_IdentifyProgress& wire) {
  return Guarded([&] { return IdentifyProgress{ReadProgress(wire)}; });
}

Decoded<IdentifyReply> Decode(const telltale_wire_IdentifyReply& wire) {
  return Guarded([&] {
    IdentifyReply reply{ReadReply(wire), {}};
    if (HasPublishedItem("model", wire.model, reply))
      reply.model = ReadModel(wire.model._buffer[0]);
    return reply;
  });
}

Decoded<PublishedDiagnosis> Decode(const telltale_wire_Diagnosis& wire) {
  return Guarded([&] { return ReadDiagnosis(wire); });
}

Decoded<DiagnoseRequest> Decode(const telltale_wire_DiagnoseRequest& wire) {
  return Guarded([&] {
    DiagnoseRequest request;
    request.correlation_id = ReadIdentifier("correlation_id", wire.correlation_id);
    request.vehicle_id = ReadIdentifier("vehicle_id", wire.vehicle_id);
    request.refit = wire.refit;
    request.without = ReadSequence(
        "without", wire.without,
        [](const std::string&, const char* effect) { return std::string(View(effect)); });
    request.seed = wire.seed;
    return request;
  });
}

Decoded<DiagnoseProgress> Decode(const telltale_wire_DiagnoseProgress& wire) {
  return Guarded([&] { return DiagnoseProgress{ReadProgress(wire)}; });
}

Decoded<DiagnoseReply> Decode(const telltale_wire_DiagnoseReply& wire) {
  return Guarded([&] {
    DiagnoseReply reply{ReadReply(wire), {}, {}};
    if (HasPublishedItem("diagnosis", wire.diagnosis, reply)) {
      reply.diagnosis = ReadDiagnosis(wire.diagnosis._buffer[0]);
    }
    reply.augmented = ReadAugmented(wire.augmented, reply);
    return reply;
  });
}

Decoded<Quality> Decode(const telltale_wire_Quality& wire) {
  return Guarded([&] {
    Quality quality;
    quality.vehicle_id = View(wire.vehicle_id) == kUnattributed
                             ? std::string(kUnattributed)
                             : ReadIdentifier("vehicle_id", wire.vehicle_id);
    quality.sequence_number = wire.sequence_number;
    quality.window_s = ReadWithin("window_s", wire.window_s, 0.0, kLargest);
    quality.window_fill = ReadWithin("window_fill", wire.window_fill, 0.0, 1.0);
    quality.gnss_rate_hz = ReadWithin("gnss_rate_hz", wire.gnss_rate_hz, 0.0, kLargest);
    quality.heading_rate_hz = ReadWithin("heading_rate_hz", wire.heading_rate_hz, 0.0, kLargest);
    quality.thrusters_rate_hz =
        ReadWithin("thrusters_rate_hz", wire.thrusters_rate_hz, 0.0, kLargest);
    quality.lost = wire.lost;
    quality.accepted = wire.accepted;
    quality.rejected = ReadSequence("rejected", wire.rejected, ReadRejectEntry);
    if (wire.has_model) quality.model_revision = wire.model_revision;
    quality.model_age_s = ReadWithin("model_age_s", wire.model_age_s, -kLargest, kLargest);
    quality.prediction_error = ReadWithin("prediction_error", wire.prediction_error, 0.0, kLargest);
    quality.drift = ReadWithin("drift", wire.drift, -kLargest, kLargest);
    quality.indicative = ReadSequence("indicative", wire.indicative, ReadIndicative);
    quality.indicative_rows = wire.indicative_rows;
    quality.proposal = View(wire.proposal);
    return quality;
  });
}

}  // namespace telltale
