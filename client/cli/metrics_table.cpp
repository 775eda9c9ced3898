#include "telltale/client/cli/metrics_table.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "telltale/client/cli/table.hpp"
#include "telltale/core/simulation/divergence.hpp"
#include "telltale/core/vessel/model_structure.hpp"

namespace telltale {
namespace {

std::string VelocityText(Equation equation) {
  switch (equation) {
    case Equation::kSurge: return "surge u (m/s)";
    case Equation::kSway: return "sway v (m/s)";
    case Equation::kYaw: return "yaw r (rad/s)";
    case Equation::kUnknown: break;
  }
  return "";
}

std::string OneStepTable(const Metrics& metrics) {
  Table table({{"one step", Align::kLeft},
               {"R2", Align::kRight},
               {"R2 of constant velocity", Align::kRight},
               {"MAE", Align::kRight}});
  for (const Equation equation : kEquations) {
    const OneStepScore& score = metrics.one_step[IndexOf(equation)];
    table.AddRow({VelocityText(equation), Fixed(score.r2, 4), Fixed(score.constant_velocity_r2, 4),
                  Significant(score.mae, 3)});
  }
  return table.Render();
}

/// The size of the error of a diverged run has no meaning.
bool Diverges(const FreeRunScore& score) {
  return !(score.rmse < kOpenLoopDivergence.speed_mps);
}

std::vector<std::string> Row(Equation equation, const FreeRunScore& score) {
  const std::string constant_velocity = Significant(score.constant_velocity_rmse, 3);
  const std::string floor = Significant(score.noise_floor, 3);
  if (Diverges(score))
    return {VelocityText(equation), "diverges", constant_velocity, floor, "–", "–"};
  return {VelocityText(equation),    Significant(score.rmse, 3), constant_velocity, floor,
          Significant(score.mae, 3), Fixed(score.r2, 3)};
}

std::string HorizonText(const FreeRunScores& scores) {
  const std::string horizon = Plain(scores.horizon_s) + " s: ";
  if (scores.windows == 0) return horizon + "no segment without gaps is this long";
  const std::string windows = horizon + Counted(scores.windows, "window", "windows");
  if (Diverges(scores)) return windows + ", in some of which the model diverges";
  return windows + ", position off by " + Significant(scores.position_rmse_m, 3) +
         " m RMS at the end";
}

std::string FreeRunTable(const Metrics& metrics) {
  Table table({{"free run", Align::kLeft},
               {"RMSE", Align::kRight},
               {"of constant velocity", Align::kRight},
               {"noise floor", Align::kRight},
               {"MAE", Align::kRight},
               {"R2", Align::kRight}});
  for (const FreeRunScores& scores : metrics.free_run) {
    table.AddHeading(HorizonText(scores));
    if (scores.windows == 0) continue;
    for (const Equation equation : kEquations) {
      table.AddRow(Row(equation, scores.velocity[IndexOf(equation)]));
    }
  }
  return table.Render();
}

}  // namespace

bool Diverges(const FreeRunScores& scores) {
  return std::any_of(scores.velocity.begin(), scores.velocity.end(),
                     [](const FreeRunScore& score) { return Diverges(score); });
}

std::string MetricsTable(const Metrics& metrics) {
  return OneStepTable(metrics) + '\n' + FreeRunTable(metrics);
}

}  // namespace telltale
