#include "telltale/idl/codec/json/report.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>

#include "telltale/core/base/contract.hpp"
#include "telltale/idl/codec/field_reader.hpp"
#include "telltale/idl/codec/json/json_message.hpp"
#include "telltale/idl/codec/json/metrics.hpp"
#include "telltale/idl/codec/json/proto_values.hpp"
#include "telltale/idl/codec/vehicle_file.hpp"

namespace telltale {
namespace {

constexpr const char* kUnknownEffect = "unknown";

using Region = proto::GapCell;

// ---- to Protobuf --------------------------------------------------------------------------

proto::GapCell::PropellerRegion RegionOf(const std::optional<PropellerRegion>& region) {
  constexpr int kFirst = static_cast<int>(Region::FF);
  return region ? static_cast<Region::PropellerRegion>(kFirst + static_cast<int>(*region))
                : Region::ALL;
}

template <class Message>
void Write(const std::optional<ExcessExplained>& closure, Message& message) {
  if (!closure) return;
  message.set_closure(closure->share);
  proto::Interval& interval = *message.mutable_closure_interval();
  interval.set_level(closure->interval.level);
  interval.set_lower(closure->interval.lower);
  interval.set_upper(closure->interval.upper);
}

template <class Message>
void Write(const GapSize& size, Message& message) {
  message.set_before(size.before);
  message.set_after(size.after);
  message.set_noise_floor(size.noise_floor);
  message.set_floor_limit(size.floor_limit);
}

void Write(const Gap& gap, proto::Gap& message) {
  message.set_horizon_s(gap.horizon_s);
  message.set_windows(Saturated(gap.windows));
  Write(gap.all, message);
  Write(gap.excess_explained, message);
  for (const Equation equation : kEquations) {
    proto::ChannelGap& channel = *message.add_channels();
    channel.set_channel(EnumCast<proto::Equation>(equation));
    Write(gap.channels[IndexOf(equation)], channel);
    Write(gap.channel_excess_explained[IndexOf(equation)], channel);
  }
}

void Write(const GapCell& cell, proto::GapCell& message) {
  message.set_channel(EnumCast<proto::Equation>(cell.channel));
  message.set_propeller_region(RegionOf(cell.region));
  message.set_bin(cell.bin);
  message.set_excess_share(cell.excess_share);
  message.set_p_value(cell.p_value);
  message.set_kind(EnumCast<proto::GapCell::Kind>(cell.kind));
  message.set_mean(cell.mean);
  message.set_windows(Saturated(cell.windows));
}

void Write(const CausalEffect& effect, proto::Cause& message) {
  message.add_effects(effect.effect);
  for (const ParameterEstimate& estimate : effect.parameters) {
    proto::Cause::Parameter& parameter = *message.add_parameters();
    parameter.set_name(estimate.name);
    parameter.set_estimate(estimate.estimate);
    parameter.set_standard_error(estimate.standard_error);
    parameter.set_unit(estimate.unit);
    parameter.set_effect(effect.effect);
  }
  proto::Cause::Part& part = *message.add_parts();
  part.set_effect(effect.effect);
  part.set_sentence(effect.sentence);
  part.set_shapley_share(effect.shapley_share);
}

void Write(const Cause& cause, proto::Cause& message) {
  for (const CausalEffect& effect : cause.effects) Write(effect, message);
  if (cause.effects.empty()) message.add_effects(kUnknownEffect);
  message.set_probability(cause.probability);
  for (const std::string& other : cause.indistinguishable) message.add_indistinguishable(other);
  Write(cause.excess_explained, message);
}

void Write(const EffectTestability& effect, proto::EffectTestability& message) {
  message.set_effect(effect.effect);
  message.set_testability(EnumCast<proto::EffectTestability::Testability>(effect.testability));
  message.set_detectability(effect.detectability);
  message.set_masked_by(effect.masked_by);
}

void Write(const SeparationAdvice& advice, proto::SeparationAdvice& message) {
  message.set_manoeuvre(advice.manoeuvre);
  message.set_how(advice.how);
  for (const std::string& effect : advice.separates) message.add_separates(effect);
  message.set_duration_s(advice.duration_s);
  message.set_expected_nats(advice.expected_nats);
  message.set_decisive(advice.decisive);
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

using Numbers = google::protobuf::RepeatedField<double>;

void Write(const std::vector<Eigen::Vector2d>& path, Numbers& numbers) {
  for (const Eigen::Vector2d& point : path) numbers.Add(point.begin(), point.end());
}

void Write(const WindowPicture& picture, proto::WindowPicture& message) {
  message.set_time_s(picture.time_s);
  message.set_before(picture.before);
  message.set_after(picture.after);
  message.set_psi_rad(picture.psi_rad);
  message.set_speed_m_s(picture.speed_m_s);
  message.set_propeller_region(RegionOf(picture.region));
  message.mutable_error_before()->Add(picture.error_before.begin(), picture.error_before.end());
  message.mutable_error_after()->Add(picture.error_after.begin(), picture.error_after.end());
}

void WritePaths(const WindowPicture& picture, proto::WindowPicture& message) {
  Write(picture.measured, *message.mutable_measured());
  Write(picture.predicted_before, *message.mutable_predicted_before());
  Write(picture.predicted_after, *message.mutable_predicted_after());
}

// ---- from Protobuf ------------------------------------------------------------------------

template <class Core, class Proto>
Core ReadEnum(FieldReader& reader, const char* field, Proto value) {
  const auto& type = *google::protobuf::GetEnumDescriptor<Proto>();
  const int number = static_cast<int>(value);
  if (number >= 1 && number < type.value_count()) return EnumCast<Core>(value);
  std::string allowed;
  for (int i = 1; i < type.value_count(); ++i) {
    allowed += (allowed.empty() ? "one of " : ", ") + type.value(i)->name();
  }
  reader.Fail(field, number == 0 ? "" : std::to_string(number), allowed);
  return Core{};
}

std::optional<PropellerRegion> ReadRegion(FieldReader& reader, Region::PropellerRegion value) {
  const int number = ReadEnum<int>(reader, "propeller_region", value);
  if (number == static_cast<int>(Region::ALL)) return std::nullopt;
  return static_cast<PropellerRegion>(std::max(number - static_cast<int>(Region::FF), 0));
}

Interval ReadInterval(FieldReader reader) {
  return {reader.Number("level", kShare), reader.Number("lower", kNotNan),
          reader.Number("upper", kNotNan)};
}

std::optional<ExcessExplained> ReadExcessExplained(FieldReader& reader) {
  if (!reader.Has("closure")) return std::nullopt;
  return ExcessExplained{reader.Number("closure", kNotNan),
                         ReadInterval(reader.Required("closure_interval"))};
}

GapSize ReadSize(FieldReader& reader) {
  return {reader.Number("before", kNotNegative), reader.Number("after", kNotNegative),
          reader.Number("noise_floor", kNotNegative), reader.Number("floor_limit", kNotNegative)};
}

Gap ReadGap(FieldReader reader, const proto::Gap& message) {
  Gap gap;
  gap.horizon_s = reader.Number("horizon_s", {0.0, kNotNegative.high, true});
  gap.windows = message.windows();
  gap.all = ReadSize(reader);
  gap.excess_explained = ReadExcessExplained(reader);
  for (int i = 0; i < message.channels_size(); ++i) {
    FieldReader item = reader.Item("channels", i);
    const auto channel = ReadEnum<Equation>(item, "channel", message.channels(i).channel());
    if (channel == Equation::kUnknown) continue;
    gap.channels[IndexOf(channel)] = ReadSize(item);
    gap.channel_excess_explained[IndexOf(channel)] = ReadExcessExplained(item);
  }
  return gap;
}

GapCell ReadCell(FieldReader reader, const proto::GapCell& message) {
  GapCell cell;
  cell.channel = ReadEnum<Equation>(reader, "channel", message.channel());
  cell.region = ReadRegion(reader, message.propeller_region());
  cell.bin = message.bin();
  cell.excess_share = reader.Number("excess_share", kNotNan);
  cell.p_value = reader.Number("p_value", kShare);
  cell.kind = ReadEnum<GapKind>(reader, "kind", message.kind());
  cell.mean = reader.Number("mean", kNotNan);
  cell.windows = message.windows();
  return cell;
}

void ReadPart(FieldReader reader, const proto::Cause::Part& message, Cause& cause) {
  for (CausalEffect& effect : cause.effects) {
    if (effect.effect != message.effect()) continue;
    effect.sentence = message.sentence();
    effect.shapley_share = reader.Number("shapley_share", kNotNan);
    return;
  }
  reader.Fail("effect", message.effect(), "an effect of this cause");
}

void ReadParameter(FieldReader reader, const proto::Cause::Parameter& message, Cause& cause) {
  for (CausalEffect& effect : cause.effects) {
    if (effect.effect != message.effect()) continue;
    effect.parameters.push_back({message.name(), reader.Number("estimate", kNotNan),
                                 reader.Number("standard_error", kNotNegative), message.unit()});
    return;
  }
  reader.Fail("effect", message.effect(), "an effect of this cause");
}

Cause ReadCause(FieldReader reader, const proto::Cause& message) {
  Cause cause;
  for (const std::string& effect : message.effects()) {
    if (effect != kUnknownEffect) cause.effects.push_back({effect, {}, "", 1.0});
  }
  cause.probability = reader.Number("probability", kShare);
  for (int i = 0; i < message.parameters_size(); ++i) {
    ReadParameter(reader.Item("parameters", i), message.parameters(i), cause);
  }
  for (int i = 0; i < message.parts_size(); ++i) {
    ReadPart(reader.Item("parts", i), message.parts(i), cause);
  }
  cause.indistinguishable = {message.indistinguishable().begin(),
                             message.indistinguishable().end()};
  cause.excess_explained = ReadExcessExplained(reader);
  return cause;
}

EffectTestability ReadTestability(FieldReader reader, const proto::EffectTestability& message) {
  return {message.effect(), ReadEnum<Testability>(reader, "testability", message.testability()),
          reader.Number("detectability", kNotNegative), message.masked_by()};
}

SeparationAdvice ReadAdvice(FieldReader reader, const proto::SeparationAdvice& message) {
  return {message.manoeuvre(),
          message.how(),
          {message.separates().begin(), message.separates().end()},
          reader.Number("duration_s", kNotNegative),
          reader.Number("expected_nats", kNotNan),
          message.decisive()};
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

std::vector<Eigen::Vector2d> ReadPath(FieldReader& reader, const char* field,
                                      const Numbers& numbers) {
  if (numbers.size() % 2 != 0) {
    reader.Fail(field, std::to_string(numbers.size()) + " numbers", "pairs of north and east");
    return {};
  }
  std::vector<Eigen::Vector2d> path;
  for (int i = 0; i < numbers.size(); i += 2) path.emplace_back(numbers[i], numbers[i + 1]);
  return path;
}

Eigen::Vector3d ReadErrors(FieldReader& reader, const char* field, const Numbers& numbers) {
  if (numbers.size() == 3) return {numbers[0], numbers[1], numbers[2]};
  reader.Fail(field, std::to_string(numbers.size()) + " numbers",
              "3: along, across and in heading");
  return Eigen::Vector3d::Zero();
}

WindowPicture ReadPicture(FieldReader reader, const proto::WindowPicture& message) {
  WindowPicture picture;
  picture.time_s = reader.Number("time_s", kNotNan);
  picture.before = reader.Number("before", kNotNegative);
  picture.after = reader.Number("after", kNotNegative);
  picture.psi_rad = reader.Number("psi_rad", kNotNan);
  picture.speed_m_s = reader.Number("speed_m_s", kNotNegative);
  const auto region = ReadRegion(reader, message.propeller_region());
  if (!region) reader.Fail("propeller_region", "ALL", "one of FF, FR, RF, RR");
  picture.region = region.value_or(PropellerRegion::kFF);
  picture.error_before = ReadErrors(reader, "error_before", message.error_before());
  picture.error_after = ReadErrors(reader, "error_after", message.error_after());
  picture.measured = ReadPath(reader, "measured", message.measured());
  picture.predicted_before = ReadPath(reader, "predicted_before", message.predicted_before());
  picture.predicted_after = ReadPath(reader, "predicted_after", message.predicted_after());
  return picture;
}

/// Every item of a repeated message field through `read`.
template <class Messages, class Read>
auto ReadAll(FieldReader& reader, const char* field, const Messages& messages, Read read) {
  std::vector<decltype(read(reader, messages[0]))> items;
  for (int i = 0; i < messages.size(); ++i) {
    items.push_back(read(reader.Item(field, i), messages[i]));
  }
  return items;
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
  diagnosis.where = ReadAll(reader, "where", report.where(), ReadCell);
  diagnosis.causes = ReadAll(reader, "causes", report.causes(), ReadCause);
  diagnosis.effects = ReadAll(reader, "effects", report.effects(), ReadTestability);
  diagnosis.advice = ReadAll(reader, "advice", report.advice(), ReadAdvice);
  if (report.has_onset()) diagnosis.onset = ReadOnset(reader.Optional("onset"));
  diagnosis.rest = report.rest();
  if (report.has_improvement()) diagnosis.improvement = ReadImprovement(report.improvement());
  diagnosis.pictures = ReadAll(reader, "pictures", report.pictures(), ReadPicture);
  diagnosis.notes = {report.notes().begin(), report.notes().end()};
  diagnosis.seed = report.seed();
  diagnosis.software_version = report.software_version();
  return diagnosis;
}

}  // namespace

std::vector<std::size_t> WorstWindows(const std::vector<WindowPicture>& pictures) {
  std::vector<std::size_t> windows;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    if (!pictures[i].measured.empty()) windows.push_back(i);
  }
  std::stable_sort(windows.begin(), windows.end(), [&](std::size_t a, std::size_t b) {
    return pictures[a].before > pictures[b].before;
  });
  windows.resize(std::min(windows.size(), kShownPaths));
  std::sort(windows.begin(), windows.end());
  return windows;
}

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
  Write(diagnosis.Main(), *report.mutable_gap());
  for (const Gap& gap : diagnosis.gaps) Write(gap, *report.add_horizons());
  for (const GapCell& cell : diagnosis.where) Write(cell, *report.add_where());
  for (const Cause& cause : diagnosis.causes) Write(cause, *report.add_causes());
  for (const EffectTestability& effect : diagnosis.effects) Write(effect, *report.add_effects());
  for (const SeparationAdvice& advice : diagnosis.advice) Write(advice, *report.add_advice());
  if (diagnosis.onset) Write(*diagnosis.onset, *report.mutable_onset());
  report.set_rest(diagnosis.rest);
  if (diagnosis.improvement) Write(*diagnosis.improvement, *report.mutable_improvement());
  for (const WindowPicture& picture : diagnosis.pictures) Write(picture, *report.add_pictures());
  for (const std::size_t i : WorstWindows(diagnosis.pictures)) {
    WritePaths(diagnosis.pictures[i], *report.mutable_pictures(static_cast<int>(i)));
  }
  for (const std::string& note : diagnosis.notes) report.add_notes(note);
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
