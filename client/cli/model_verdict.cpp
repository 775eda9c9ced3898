#include "telltale/client/cli/model_verdict.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "telltale/client/cli/metrics_table.hpp"
#include "telltale/client/cli/table.hpp"
#include "telltale/core/identification/experiment_design.hpp"

namespace telltale {
namespace {

struct VelocityName {
  const char* name;
  const char* unit;
};

constexpr std::array<VelocityName, 3> kVelocityNames = {
    {{"surge", "m/s"}, {"sway", "m/s"}, {"yaw", "rad/s"}}};

std::string HeldOutPart(const HeldOutScore& score) {
  return "the last " + Fixed(score.held_out_s, 0) + " s by a model made from the first " +
         Fixed(score.training_s, 0) + " s";
}

std::string ErrorsText(const FreeRunScores& scores) {
  std::string text;
  for (std::size_t i = 0; i < kVelocityNames.size(); ++i) {
    const auto& [name, unit] = kVelocityNames[i];
    const FreeRunScore& score = scores.velocity[i];
    text += std::string(i == 0 ? "" : ", ") + name + ' ' + Significant(score.rmse, 2) + ' ' + unit +
            " (" + Significant(score.constant_velocity_rmse, 2) + ')';
  }
  return text;
}

std::string PredictionText(const std::optional<HeldOutScore>& score) {
  if (!score) {
    return "Prediction: not measured here; `telltale validate` scores the model on another "
           "recording.";
  }
  const FreeRunScores& scores = score->metrics.free_run.front();
  const std::string held_out = "Prediction of " + HeldOutPart(*score) + ": ";
  if (Diverges(scores)) {
    return held_out + "it diverges within " + Plain(scores.horizon_s) + " s.";
  }
  return held_out + Plain(scores.horizon_s) + " s ahead the RMS errors are " + ErrorsText(scores) +
         ", position " + Significant(scores.position_rmse_m, 2) +
         " m (in brackets: of constant velocity).";
}

/// The warning that free runs diverge, where there is one.
const Refusal* DivergenceWarning(const Identification& identification) {
  const auto found =
      std::find_if(identification.refusals.begin(), identification.refusals.end(),
                   [](const Refusal& refusal) { return refusal.subject == "free run"; });
  return found == identification.refusals.end() ? nullptr : &*found;
}

std::string SimulationText(const Identification& identification) {
  if (const auto model = ModelOf(identification); !model) {
    return "Simulation: not possible, since " + model.error().reason + '.';
  }
  if (!identification.simulation.empty()) {
    return "Simulation: possible with the regularised values below; with the estimates it "
           "diverges.";
  }
  if (DivergenceWarning(identification)) {
    return "Simulation: not advised, it diverges over its own recording.";
  }
  return "Simulation: possible; free runs over its own recording stay bounded.";
}

std::string NextText(const Identification& identification) {
  for (const ManoeuvreAdvice& advice : identification.advice) {
    const std::string words = InWords(advice, 2);
    if (words.empty()) continue;
    return "Next: " + words + (advice.how.empty() ? "." : ". How: " + advice.how + '.');
  }
  if (!identification.refusals.empty()) {
    return "Next: " + identification.refusals.front().advice + '.';
  }
  return "Next: no manoeuvre of the catalogue would tighten the bounds by much.";
}

}  // namespace

std::string ModelVerdict(const Identification& identification,
                         const std::optional<HeldOutScore>& score) {
  return Wrapped(PredictionText(score)) + Wrapped(SimulationText(identification)) +
         Wrapped(NextText(identification));
}

}  // namespace telltale
