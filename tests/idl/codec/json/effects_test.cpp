#include "telltale/idl/codec/json/effects.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/made_up_identifications.hpp"
#include "telltale/core/effects/effect.hpp"
#include "telltale/idl/codec/json/model.hpp"
#include "telltale/idl/codec/wire/model.hpp"

namespace telltale {
namespace {

using testing::HasSubstr;

/// Every effect of the library, each parameter a different way into its range.
std::vector<AddedEffect> AllEffects() {
  std::vector<AddedEffect> effects;
  for (const Effect* effect : EffectLibrary()) {
    AddedEffect added{std::string(effect->Name()), {}};
    double share = 0.5;
    for (const EffectParameter& parameter : effect->Parameters()) {
      added.values.push_back(parameter.lower +
                             (share *= 0.75) * (parameter.upper - parameter.lower));
    }
    effects.push_back(added);
  }
  return effects;
}

void ExpectSameEffects(const Identification& a, const Identification& b) {
  ASSERT_EQ(a.effects.size(), b.effects.size());
  for (std::size_t i = 0; i < a.effects.size(); ++i) {
    EXPECT_EQ(a.effects[i].effect, b.effects[i].effect);
    EXPECT_EQ(a.effects[i].values, b.effects[i].values);
  }
}

Identification WithAllEffects() {
  Identification made = MadeUpIdentification();
  made.effects = AllEffects();
  return made;
}

CodecError ErrorOf(const proto::Model& model) {
  const auto identification = IdentificationOf(model);
  return identification ? CodecError{} : identification.error();
}

TEST(EffectsJson, PrintedAndReadAgainIsTheSame) {
  const Identification made = WithAllEffects();
  const auto again = ParseModelJson(PrintModelJson(made));
  ASSERT_TRUE(again) << again.error().Message();
  ExpectSameEffects(*again, made);
}

TEST(EffectsJson, CrossTheBusUnchanged) {
  const Identification made = WithAllEffects();
  const auto again = Decode(*Encode(PublishedModel{made, 1, 0.0}));
  ASSERT_TRUE(again) << again.error().Message();
  ExpectSameEffects(again->identification, made);
}

TEST(EffectsJson, OlderModelsHaveNone) {
  proto::Model model = ToProto(WithAllEffects());
  model.clear_effects();
  const auto again = IdentificationOf(model);
  ASSERT_TRUE(again) << again.error().Message();
  EXPECT_TRUE(again->effects.empty());
}

TEST(EffectsJson, RefusesAnEffectThatTheLibraryLacksAndNamesThoseItHas) {
  proto::Model model = ToProto(WithAllEffects());
  model.mutable_effects(1)->set_effect("kraken");
  const CodecError error = ErrorOf(model);
  EXPECT_EQ(error.field, "effects[1].effect");
  EXPECT_THAT(error.value, HasSubstr("kraken"));
  for (const Effect* effect : EffectLibrary()) {
    EXPECT_THAT(error.allowed, HasSubstr(std::string(effect->Name())));
  }
}

// As a property of the nominal boat, and as what the diagnosis found.
TEST(EffectsJson, KeepsAnEffectThatActsTwice) {
  Identification made = WithAllEffects();
  made.effects.push_back(made.effects.front());
  const auto read = IdentificationOf(ToProto(made));
  ASSERT_TRUE(read.has_value());
  ExpectSameEffects(*read, made);
}

TEST(EffectsJson, RefusesParametersThatAreNotTheEffectsOwn) {
  const proto::Model made = ToProto(WithAllEffects());
  proto::Model model = made;
  model.mutable_effects(0)->mutable_parameters()->RemoveLast();
  EXPECT_EQ(ErrorOf(model).field, "effects[0].parameters");

  model = made;
  model.mutable_effects(0)->mutable_parameters(0)->set_name("mood");
  EXPECT_EQ(ErrorOf(model).field, "effects[0].parameters[0].name");

  model = made;
  model.mutable_effects(0)->mutable_parameters(0)->set_unit("furlong");
  EXPECT_EQ(ErrorOf(model).field, "effects[0].parameters[0].unit");
}

TEST(EffectsJson, RefusesValuesOutOfRangeAndNamesTheRange) {
  const EffectParameter& parameter = EffectLibrary()[0]->Parameters()[0];
  for (const double value :
       {parameter.lower - 1.0, parameter.upper + 1.0, std::nan(""), HUGE_VAL}) {
    proto::Model model = ToProto(WithAllEffects());
    model.mutable_effects(0)->mutable_parameters(0)->set_value(value);
    const CodecError error = ErrorOf(model);
    EXPECT_EQ(error.field, "effects[0].parameters[0].value");
    EXPECT_THAT(error.allowed, HasSubstr(NumberText(parameter.upper)));

    Identification made = WithAllEffects();
    made.effects[0].values[0] = value;
    const auto decoded = Decode(*Encode(PublishedModel{made, 1, 0.0}));
    ASSERT_FALSE(decoded);
    EXPECT_THAT(decoded.error().field, HasSubstr("effects[0]"));
  }
}

TEST(EffectsJson, RefusesUnknownEffectsAndWrongNumbersOfValuesOnTheBus) {
  Identification made = WithAllEffects();
  made.effects[0].effect = "kraken";
  EXPECT_EQ(Decode(*Encode(PublishedModel{made, 1, 0.0})).error().field, "effects[0].effect");

  made = WithAllEffects();
  made.effects[0].values.push_back(0.0);
  EXPECT_EQ(Decode(*Encode(PublishedModel{made, 1, 0.0})).error().field, "effects[0].values");
}

}  // namespace
}  // namespace telltale
