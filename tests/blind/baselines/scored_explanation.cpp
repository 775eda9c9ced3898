#include "baselines/scored_explanation.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace blind::baselines {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kListed = 5;

Json Names(const ScoredExplanation& explanation) {
  Json names = Json::array();
  for (const auto& [effect, values] : explanation.effects) names.push_back(effect->Name());
  return names;
}

Json Parameters(const ScoredExplanation& explanation) {
  Json parameters = Json::array();
  for (const auto& [effect, values] : explanation.effects) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      const telltale::EffectParameter& parameter = effect->Parameters()[i];
      parameters.push_back({{"effect", effect->Name()},
                            {"name", parameter.name},
                            {"estimate", values[i]},
                            {"unit", parameter.unit}});
    }
  }
  return parameters;
}

}  // namespace

std::string ReportOf(std::vector<ScoredExplanation> explanations, const ReferenceBasis& basis) {
  std::stable_sort(
      explanations.begin(), explanations.end(),
      [](const ScoredExplanation& a, const ScoredExplanation& b) { return a.bic < b.bic; });
  const auto weight = [&](const ScoredExplanation& explanation) {
    return std::exp(-0.5 * (explanation.bic - explanations.front().bic));
  };
  double sum = 0.0;
  for (const ScoredExplanation& explanation : explanations) sum += weight(explanation);
  const bool named = !explanations.front().effects.empty();
  Json report{{"verdict", named ? "EXPLAINED" : "NO_MATERIAL_GAP"}, {"causes", Json::array()}};
  for (const ScoredExplanation& explanation : explanations) {
    if (explanation.effects.empty() || report["causes"].size() == kListed) continue;
    report["causes"].push_back({{"effects", Names(explanation)},
                                {"probability", weight(explanation) / sum},
                                {"parameters", Parameters(explanation)}});
  }
  if (const auto closure = basis.ClosureBy(basis.With(explanations.front().effects));
      named && closure) {
    report["gap"]["closure"] = *closure;
  }
  return report.dump(1) + '\n';
}

}  // namespace blind::baselines
