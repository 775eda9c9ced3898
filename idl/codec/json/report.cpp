#include "telltale/idl/codec/json/report.hpp"

#include "telltale/core/base/contract.hpp"
#include "telltale/core/diagnosis/diagnosis_constants.hpp"
#include "telltale/idl/codec/field_reader.hpp"
#include "telltale/idl/codec/json/causes.hpp"
#include "telltale/idl/codec/json/gap.hpp"
#include "telltale/idl/codec/json/json_message.hpp"
#include "telltale/idl/codec/json/metrics.hpp"
#include "telltale/idl/codec/json/missing_force.hpp"
#include "telltale/idl/codec/json/proto_values.hpp"
#include "telltale/idl/codec/json/window_pictures.hpp"
#include "telltale/idl/codec/vehicle_file.hpp"

namespace telltale {
namespace {

void Write(const EffectTestability& effect, proto::EffectTestability& message) {
  message.set_effect(effect.effect);
  message.set_testability(EnumCast<proto::EffectTestability::Testability>(effect.testability));
  message.set_detectability(effect.detectability);
  message.set_masked_by(effect.masked_by);
  for (const auto& [parameter, size, unit] : effect.detectable_sizes) {
    auto& detectable = *message.add_detectable_sizes();
    detectable.set_name(parameter);
    if (size) detectable.set_size(*size);
    detectable.set_unit(unit);
  }
}

void Write(const DelayDifference& delay, proto::DelayDifference& message) {
  message.set_channel(EnumCast<proto::DelayDifference::Channel>(delay.channel));
  message.set_difference_s(delay.difference_s);
  message.set_standard_deviation_s(delay.standard_deviation_s);
  message.set_score(delay.score);
  if (delay.detectable_s) message.set_detectable_s(*delay.detectable_s);
}

void Write(const OddsTerm& term, proto::OddsTerm& message) {
  message.set_name(term.name);
  message.set_value(term.value);
  message.set_log_odds(term.log_odds);
}

void Write(const SeparationAdvice& advice, proto::SeparationAdvice& message) {
  message.set_manoeuvre(advice.manoeuvre);
  message.set_how(advice.how);
  for (const std::string& effect : advice.separates) message.add_separates(effect);
  message.set_duration_s(advice.duration_s);
  message.set_expected_nats(advice.expected_nats);
  message.set_decisive(advice.decisive);
}

void Write(const ReferenceInfluence& influence, proto::ReferenceInfluence& message) {
  message.set_reference(influence.reference);
  message.set_verdict(EnumCast<proto::DiagnosisVerdict>(influence.verdict));
  for (const std::string& effect : influence.effects) message.add_effects(effect);
  message.set_probability(influence.probability);
  message.set_before(influence.gap.before);
  message.set_noise_floor(influence.gap.noise_floor);
  message.set_floor_limit(influence.gap.floor_limit);
  if (influence.own_gap) message.set_own_gap(*influence.own_gap);
}

void Write(const Onset& onset, proto::Onset& message) {
  message.set_time_s(onset.time_s);
  message.set_earliest_s(onset.earliest_s);
  message.set_latest_s(onset.latest_s);
}

void Write(const Improvement& improvement, proto::Improvement& message) {
  for (const FreeRunScores& scores : improvement.before) *message.add_before() = ToProto(scores);
  for (const FreeRunScores& scores : improvement.after) *message.add_after() = ToProto(scores);
}

DetectableSize ReadDetectableSize(FieldReader reader,
                                  const proto::EffectTestability::DetectableSize& message) {
  DetectableSize detectable{message.name(), std::nullopt, message.unit()};
  if (message.has_size()) detectable.size = reader.Number("size", kNotNegative);
  return detectable;
}

EffectTestability ReadTestability(FieldReader reader, const proto::EffectTestability& message) {
  return {message.effect(), ReadEnum<Testability>(reader, "testability", message.testability()),
          reader.Number("detectability", kNotNegative), message.masked_by(),
          ReadAll(reader, "detectable_sizes", message.detectable_sizes(), ReadDetectableSize)};
}

DelayDifference ReadDelay(FieldReader reader, const proto::DelayDifference& message) {
  DelayDifference delay{ReadEnum<DelayedChannel>(reader, "channel", message.channel()),
                        reader.Number("difference_s", kNotNan),
                        reader.Number("standard_deviation_s", kNotNegative),
                        reader.Number("score", kNotNan), std::nullopt};
  if (message.has_detectable_s()) delay.detectable_s = reader.Number("detectable_s", kNotNegative);
  return delay;
}

OddsTerm ReadOddsTerm(FieldReader reader, const proto::OddsTerm& message) {
  return {message.name(), reader.Number("value", kNotNan), reader.Number("log_odds", kNotNan)};
}

SeparationAdvice ReadAdvice(FieldReader reader, const proto::SeparationAdvice& message) {
  return {message.manoeuvre(),
          message.how(),
          {message.separates().begin(), message.separates().end()},
          reader.Number("duration_s", kNotNegative),
          reader.Number("expected_nats", kNotNan),
          message.decisive()};
}

ReferenceInfluence ReadInfluence(FieldReader reader, const proto::ReferenceInfluence& message) {
  ReferenceInfluence influence;
  influence.reference = message.reference();
  // Zero is a value here: no diagnosis.
  if (message.verdict() != proto::UNKNOWN_VERDICT) {
    influence.verdict = ReadEnum<Verdict>(reader, "verdict", message.verdict());
  }
  influence.effects = {message.effects().begin(), message.effects().end()};
  influence.probability = reader.Number("probability", kShare);
  influence.gap.before = reader.Number("before", kNotNegative);
  influence.gap.noise_floor = reader.Number("noise_floor", kNotNegative);
  influence.gap.floor_limit = reader.Number("floor_limit", kNotNegative);
  influence.gap.after = influence.gap.before;
  if (message.has_own_gap()) influence.own_gap = reader.Number("own_gap", kNotNegative);
  return influence;
}

Onset ReadOnset(FieldReader reader) {
  return {reader.Number("time_s", kNotNan), reader.Number("earliest_s", kNotNan),
          reader.Number("latest_s", kNotNan)};
}

Improvement ReadImprovement(const proto::Improvement& message) {
  Improvement improvement;
  for (const auto& scores : message.before()) improvement.before.push_back(ScoresOf(scores));
  for (const auto& scores : message.after()) improvement.after.push_back(ScoresOf(scores));
  return improvement;
}

Diagnosis ReadReport(FieldReader reader, const proto::Report& report) {
  Diagnosis diagnosis;
  diagnosis.vehicle_id = report.vehicle_id();
  if (!IsVehicleId(diagnosis.vehicle_id)) {
    reader.Fail("vehicle_id", '"' + diagnosis.vehicle_id + '"', std::string(kVehicleIdAllowed));
  }
  diagnosis.verdict = ReadEnum<Verdict>(reader, "verdict", report.verdict());
  diagnosis.sentence = report.sentence();
  diagnosis.floor_basis = ReadEnum<FloorBasis>(reader, "floor_basis", report.floor_basis());
  diagnosis.reference_logs = report.reference_logs();
  diagnosis.start_s = reader.Number("start_s", kNotNan);
  diagnosis.end_s = reader.Number("end_s", kNotNan);
  if (report.horizons().empty()) reader.Fail("horizons", "(none)", "at least one");
  diagnosis.gaps = ReadAll(reader, "horizons", report.horizons(), ReadGap);
  diagnosis.where = ReadAll(reader, "where", report.where(), ReadGapCell);
  diagnosis.causes = ReadAll(reader, "causes", report.causes(), ReadCause);
  diagnosis.unknown_odds = ReadAll(reader, "unknown_odds", report.unknown_odds(), ReadOddsTerm);
  diagnosis.delays = ReadAll(reader, "delays", report.delays(), ReadDelay);
  diagnosis.effects = ReadAll(reader, "effects", report.effects(), ReadTestability);
  diagnosis.present_weather = {report.present_weather().begin(), report.present_weather().end()};
  diagnosis.advice = ReadAll(reader, "advice", report.advice(), ReadAdvice);
  diagnosis.reference_influence =
      ReadAll(reader, "reference_influence", report.reference_influence(), ReadInfluence);
  if (reader.Has("nominal_days_limit")) {
    diagnosis.nominal_days_limit = reader.Number("nominal_days_limit", kNotNegative);
  }
  if (report.has_onset()) diagnosis.onset = ReadOnset(reader.Optional("onset"));
  diagnosis.rest = report.rest();
  if (report.has_missing_force()) {
    diagnosis.missing_force =
        ReadMissingForce(reader.Optional("missing_force"), report.missing_force());
  }
  if (report.has_improvement()) diagnosis.improvement = ReadImprovement(report.improvement());
  diagnosis.pictures = ReadAll(reader, "pictures", report.pictures(), ReadPicture);
  diagnosis.notes = {report.notes().begin(), report.notes().end()};
  diagnosis.seed = report.seed();
  diagnosis.software_version = report.software_version();
  return diagnosis;
}

}  // namespace

proto::Report ToProto(const Diagnosis& diagnosis) {
  Require(!diagnosis.gaps.empty(), "a diagnosis with a gap");
  proto::Report report;
  report.set_vehicle_id(diagnosis.vehicle_id);
  report.set_verdict(EnumCast<proto::DiagnosisVerdict>(diagnosis.verdict));
  report.set_sentence(diagnosis.sentence);
  report.set_floor_basis(EnumCast<proto::FloorBasis>(diagnosis.floor_basis));
  report.set_reference_logs(Saturated(diagnosis.reference_logs));
  report.set_start_s(diagnosis.start_s);
  report.set_end_s(diagnosis.end_s);
  *report.mutable_gap() = ToProto(diagnosis.Main());
  for (const Gap& gap : diagnosis.gaps) *report.add_horizons() = ToProto(gap);
  for (const GapCell& cell : diagnosis.where) *report.add_where() = ToProto(cell);
  for (const Cause& cause : diagnosis.causes) *report.add_causes() = ToProto(cause);
  for (const OddsTerm& term : diagnosis.unknown_odds) Write(term, *report.add_unknown_odds());
  for (const DelayDifference& delay : diagnosis.delays) Write(delay, *report.add_delays());
  for (const EffectTestability& effect : diagnosis.effects) Write(effect, *report.add_effects());
  for (const std::string& weather : diagnosis.present_weather) report.add_present_weather(weather);
  for (const SeparationAdvice& advice : diagnosis.advice) Write(advice, *report.add_advice());
  for (const ReferenceInfluence& influence : diagnosis.reference_influence) {
    Write(influence, *report.add_reference_influence());
  }
  if (diagnosis.nominal_days_limit) {
    report.set_nominal_days_limit(*diagnosis.nominal_days_limit);
  }
  if (diagnosis.onset) Write(*diagnosis.onset, *report.mutable_onset());
  report.set_rest(diagnosis.rest);
  if (diagnosis.missing_force) {
    *report.mutable_missing_force() = ToProto(*diagnosis.missing_force);
  }
  if (diagnosis.improvement) Write(*diagnosis.improvement, *report.mutable_improvement());
  WritePictures(diagnosis.pictures, report);
  for (const std::string& note : diagnosis.notes) report.add_notes(note);
  report.set_detection_power(kDiagnosis.testability.power);
  report.set_seed(diagnosis.seed);
  report.set_software_version(diagnosis.software_version);
  return report;
}

Decoded<Diagnosis> DiagnosisOf(const proto::Report& report, const std::string& file) {
  const FieldSource source{file, FieldSource::Names::kJson, nullptr};
  std::optional<CodecError> fault;
  Diagnosis diagnosis = ReadReport(FieldReader(report, source, fault), report);
  if (fault) return tl::unexpected(*fault);
  return diagnosis;
}

std::string PrintReportJson(const Diagnosis& diagnosis) {
  return PrintJsonMessage(ToProto(diagnosis));
}

Decoded<Diagnosis> ParseReportJson(std::string_view text, const std::string& file) {
  proto::Report report;
  if (const auto fault = ParseJsonMessage(text, file, report)) return tl::unexpected(*fault);
  return DiagnosisOf(report, file);
}

}  // namespace telltale
