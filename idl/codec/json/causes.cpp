#include "telltale/idl/codec/json/causes.hpp"

#include <optional>
#include <string>

#include "telltale/core/base/degrees.hpp"
#include "telltale/idl/codec/json/gap.hpp"

namespace telltale {
namespace {

constexpr const char* kUnknownEffect = "unknown";

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
  if (effect.size) {
    proto::Cause::Part::Size& size = *part.mutable_size();
    size.set_name(effect.size->name);
    size.set_estimate(effect.size->estimate);
    size.set_standard_error(effect.size->standard_error);
    size.set_unit(effect.size->unit);
  }
  if (effect.towards) {
    proto::Cause::Part::Direction& direction = *part.mutable_direction();
    direction.set_towards_deg(effect.towards->centre_rad * kDegreesPerRadian);
    direction.set_half_width_deg(effect.towards->half_width_rad * kDegreesPerRadian);
    direction.set_or_opposite(effect.towards->or_opposite);
  }
}

std::optional<ParameterEstimate> ReadSize(FieldReader part) {
  if (!part.Has("size")) return std::nullopt;
  FieldReader size = part.Required("size");
  return ParameterEstimate{size.Text("name"), size.Number("estimate", kNotNan),
                           size.Number("standard_error", kNotNegative), size.Text("unit")};
}

std::optional<CircularInterval> ReadDirection(FieldReader part, const proto::Cause::Part& message) {
  if (!part.Has("direction")) return std::nullopt;
  FieldReader direction = part.Required("direction");
  return CircularInterval{direction.Number("towards_deg", {0.0, 360.0}) * kRadiansPerDegree,
                          direction.Number("half_width_deg", {0.0, 180.0}) * kRadiansPerDegree,
                          message.direction().or_opposite()};
}

void ReadPart(FieldReader reader, const proto::Cause::Part& message, Cause& cause) {
  for (CausalEffect& effect : cause.effects) {
    if (effect.effect != message.effect()) continue;
    effect.sentence = message.sentence();
    effect.shapley_share = reader.Number("shapley_share", kNotNan);
    effect.size = ReadSize(reader);
    effect.towards = ReadDirection(reader, message);
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

}  // namespace

proto::Cause ToProto(const Cause& cause) {
  proto::Cause message;
  for (const CausalEffect& effect : cause.effects) Write(effect, message);
  if (cause.effects.empty()) message.add_effects(kUnknownEffect);
  message.set_probability(cause.probability);
  for (const std::string& other : cause.indistinguishable) message.add_indistinguishable(other);
  WriteClosure(cause.excess_explained, message);
  return message;
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

}  // namespace telltale
