#include "telltale/idl/codec/json/causes.hpp"

#include <string>

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
