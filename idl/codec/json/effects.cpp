#include "telltale/idl/codec/json/effects.hpp"

#include <string>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/effects/effect.hpp"

namespace telltale {
namespace {

template <class Items>
std::string Names(const Items& items, auto name) {
  std::string names;
  for (const auto& item : items) names.append(names.empty() ? "" : ", ").append(name(item));
  return names;
}

std::string LibraryNames() {
  return Names(EffectLibrary(), [](const Effect* effect) { return effect->Name(); });
}

std::string ParameterNames(const Effect& effect) {
  return Names(effect.Parameters(), [](const EffectParameter& p) { return p.name; });
}

void Write(const AddedEffect& added, proto::AddedEffect& message) {
  const Effect* effect = FindEffect(added.effect);
  Require(effect && effect->Parameters().size() == added.values.size(),
          "an effect of the library with a value for each parameter");
  message.set_effect(added.effect);
  for (std::size_t i = 0; i < added.values.size(); ++i) {
    const EffectParameter& parameter = effect->Parameters()[i];
    proto::EffectParameter& item = *message.add_parameters();
    item.set_name(std::string(parameter.name));
    item.set_value(added.values[i]);
    item.set_unit(std::string(parameter.unit));
  }
}

double ReadValue(FieldReader reader, const proto::EffectParameter& message,
                 const EffectParameter& parameter) {
  if (message.name() != parameter.name) {
    reader.Fail("name", Quoted(message.name()), Quoted(parameter.name) + " in this place");
  }
  if (message.unit() != parameter.unit) {
    reader.Fail("unit", Quoted(message.unit()), Quoted(parameter.unit));
  }
  return reader.Number("value", {parameter.lower, parameter.upper});
}

AddedEffect ReadEffect(FieldReader reader, const proto::AddedEffect& message) {
  AddedEffect added{message.effect(), {}};
  const Effect* effect = FindEffect(added.effect);
  if (!effect) {
    reader.Fail("effect", Quoted(added.effect), "one of " + LibraryNames());
    return added;
  }
  const auto parameters = effect->Parameters();
  if (static_cast<std::size_t>(message.parameters_size()) != parameters.size()) {
    reader.Fail("parameters", std::to_string(message.parameters_size()) + " of them",
                std::to_string(parameters.size()) + ": " + ParameterNames(*effect));
    return added;
  }
  for (int i = 0; i < message.parameters_size(); ++i) {
    added.values.push_back(ReadValue(reader.Item("parameters", i), message.parameters(i),
                                     parameters[static_cast<std::size_t>(i)]));
  }
  return added;
}

}  // namespace

void WriteEffects(const std::vector<AddedEffect>& effects, proto::Model& message) {
  for (const AddedEffect& effect : effects) Write(effect, *message.add_effects());
}

std::vector<AddedEffect> ReadEffects(FieldReader& reader, const proto::Model& message) {
  std::vector<AddedEffect> effects;
  for (int i = 0; i < message.effects_size(); ++i) {
    FieldReader item = reader.Item("effects", i);
    effects.push_back(ReadEffect(item, message.effects(i)));
  }
  return effects;
}

}  // namespace telltale
