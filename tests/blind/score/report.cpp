#include "score/report.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace blind::score {
namespace {

using Json = nlohmann::json;

Json Parsed(const std::string& text) {
  Json json = Json::parse(text, nullptr, false);
  if (json.is_discarded()) throw std::invalid_argument("this is no JSON");
  if (!json.is_object()) throw std::invalid_argument("this is no JSON object");
  return json;
}

/// A member, or null: Protobuf leaves out what is zero or empty.
const Json& Member(const Json& object, const char* name) {
  static const Json nothing;
  if (!object.is_object()) return nothing;
  const auto member = object.find(name);
  return member == object.end() ? nothing : *member;
}

/// A number as Protobuf's mapping writes it, "NaN" and "Infinity" as text; nothing where it is
/// absent.
std::optional<double> NumberAt(const Json& object, const char* name) {
  const Json& member = Member(object, name);
  if (member.is_null()) return std::nullopt;
  if (member.is_number()) return member.get<double>();
  if (member == "Infinity") return INFINITY;
  if (member == "NaN" || member == "-Infinity") return std::nullopt;
  throw std::invalid_argument(std::string(name) + " is no number");
}

void RequireObject(const Json& json) {
  if (!json.is_object()) throw std::invalid_argument("there is no object where one should be");
}

std::string TextAt(const Json& object, const char* name) {
  const Json& member = Member(object, name);
  if (!member.is_string()) throw std::invalid_argument("there is no " + std::string(name));
  return member.get<std::string>();
}

/// The elements of a list, none where it is absent.
Json ListAt(const Json& object, const char* name) {
  const Json& member = Member(object, name);
  if (member.is_null()) return Json::array();
  if (!member.is_array()) throw std::invalid_argument(std::string(name) + " is no list");
  return member;
}

EffectSet Names(const Json& list) {
  EffectSet names;
  for (const Json& name : list) {
    if (!name.is_string()) throw std::invalid_argument("an effect's name is no text");
    names.insert(name.get<std::string>());
  }
  return names;
}

std::map<std::string, Direction> ParseDirections(const Json& cause) {
  std::map<std::string, Direction> directions;
  for (const Json& part : ListAt(cause, "parts")) {
    const Json& direction = Member(part, "direction");
    if (direction.is_null()) continue;
    directions[TextAt(part, "effect")] = {
        .towards_deg = NumberAt(direction, "towardsDeg").value_or(0.0),
        .half_width_deg = NumberAt(direction, "halfWidthDeg").value_or(0.0),
        .or_opposite = Member(direction, "orOpposite") == true};
  }
  return directions;
}

Cause ParseCause(const Json& json) {
  RequireObject(json);
  Cause cause{.effects = Names(ListAt(json, "effects")),
              .probability = NumberAt(json, "probability").value_or(0.0),
              .indistinguishable = {},
              .indistinguishable_sets = {},
              .directions = ParseDirections(json)};
  if (cause.effects.empty()) throw std::invalid_argument("a cause names no effect");
  if (cause.probability < 0.0 || cause.probability > 1.0) {
    throw std::invalid_argument("a cause's probability is outside [0, 1]");
  }
  for (const Json& other : ListAt(json, "indistinguishable")) {
    if (other.is_array()) {
      cause.indistinguishable_sets.insert(Names(other));
    } else {
      cause.indistinguishable.merge(Names(Json::array({other})));
    }
  }
  return cause;
}

}  // namespace

Label ParseLabel(const std::string& text) {
  const Json json = Parsed(text);
  const auto named = [&](const char* list) {
    EffectSet effects;
    for (const Json& effect : ListAt(json, list)) effects.insert(TextAt(effect, "effect"));
    return effects;
  };
  Label label{.kind = TextAt(json, "kind"),
              .effects = named("effects"),
              .weather = named("weather"),
              .sizes = {},
              .towards_deg = {}};
  for (const char* list : {"effects", "weather"}) {
    for (const Json& effect : ListAt(json, list)) {
      label.sizes[TextAt(effect, "effect")] = NumberAt(effect, "size").value_or(1.0);
      for (const Json& parameter : ListAt(effect, "parameters")) {
        if (TextAt(parameter, "name") != "towards") continue;
        label.towards_deg[TextAt(effect, "effect")] = NumberAt(parameter, "value").value_or(0.0);
      }
    }
  }
  return label;
}

Report ParseReport(const std::string& text) {
  static const EffectSet verdicts{"NO_MATERIAL_GAP", "EXPLAINED", "PARTLY_EXPLAINED",
                                  "UNKNOWN_CAUSE", "INSUFFICIENT_DATA"};
  const Json json = Parsed(text);
  Report report;
  report.verdict = TextAt(json, "verdict");
  if (!verdicts.contains(report.verdict)) {
    throw std::invalid_argument("there is no verdict " + report.verdict);
  }
  for (const Json& cause : ListAt(json, "causes")) report.causes.push_back(ParseCause(cause));
  std::stable_sort(report.causes.begin(), report.causes.end(),
                   [](const Cause& a, const Cause& b) { return a.probability > b.probability; });
  for (const Json& effect : ListAt(json, "effects")) {
    report.detectability[TextAt(effect, "effect")] =
        NumberAt(effect, "detectability").value_or(0.0);
  }
  for (const Json& term : ListAt(json, "unknownOdds")) {
    report.unknown_regressors[TextAt(term, "name")] = NumberAt(term, "value").value_or(0.0);
  }
  report.closure = NumberAt(Member(json, "gap"), "closure");
  return report;
}

double ParseRealised(const std::string& text) {
  const auto closure = NumberAt(Parsed(text), "closure");
  if (!closure) throw std::invalid_argument("there is no closure");
  return *closure;
}

}  // namespace blind::score
