#include "baselines/answer.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace blind::baselines {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kListed = 5;

Json Names(const Answer& answer) {
  Json names = Json::array();
  for (const auto& [effect, values] : answer.effects) names.push_back(effect->Name());
  return names;
}

Json Parameters(const Answer& answer) {
  Json parameters = Json::array();
  for (const auto& [effect, values] : answer.effects) {
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

std::string ReportOf(std::vector<Answer> answers, const Ground& ground) {
  std::stable_sort(answers.begin(), answers.end(),
                   [](const Answer& a, const Answer& b) { return a.bic < b.bic; });
  const auto weight = [&](const Answer& answer) {
    return std::exp(-0.5 * (answer.bic - answers.front().bic));
  };
  double sum = 0.0;
  for (const Answer& answer : answers) sum += weight(answer);
  const bool named = !answers.front().effects.empty();
  Json report{{"verdict", named ? "EXPLAINED" : "NO_MATERIAL_GAP"}, {"causes", Json::array()}};
  for (const Answer& answer : answers) {
    if (answer.effects.empty() || report["causes"].size() == kListed) continue;
    report["causes"].push_back({{"effects", Names(answer)},
                                {"probability", weight(answer) / sum},
                                {"parameters", Parameters(answer)}});
  }
  if (const auto closure = ground.ClosureBy(ground.With(answers.front().effects));
      named && closure) {
    report["gap"]["closure"] = *closure;
  }
  return report.dump(1) + '\n';
}

}  // namespace blind::baselines
