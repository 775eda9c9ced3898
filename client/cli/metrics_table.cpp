#include "cli/metrics_table.hpp"

#include "cli/table.hpp"
#include "vessel/structure.hpp"

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
               {"R2 of persistence", Align::kRight},
               {"MAE", Align::kRight}});
  for (const Equation equation : kEquations) {
    const OneStepScore& score = metrics.one_step[IndexOf(equation)];
    table.AddRow({VelocityText(equation), Fixed(score.r2, 4), Fixed(score.persistence_r2, 4),
                  Significant(score.mae, 3)});
  }
  return table.Render();
}

std::string HorizonText(const FreeRunScores& scores) {
  const std::string horizon = Significant(scores.horizon_s, 3) + " s: ";
  if (scores.windows == 0) return horizon + "no stretch without gaps is this long";
  return horizon + std::to_string(scores.windows) + " windows, position off by " +
         Significant(scores.position_rmse_m, 3) + " m RMS at the end";
}

std::string FreeRunTable(const Metrics& metrics) {
  Table table({{"free run", Align::kLeft},
               {"RMSE", Align::kRight},
               {"of persistence", Align::kRight},
               {"noise floor", Align::kRight},
               {"MAE", Align::kRight},
               {"R2", Align::kRight}});
  for (const FreeRunScores& scores : metrics.free_run) {
    table.AddHeading(HorizonText(scores));
    if (scores.windows == 0) continue;
    for (const Equation equation : kEquations) {
      const FreeRunScore& score = scores.velocity[IndexOf(equation)];
      table.AddRow({VelocityText(equation), Significant(score.rmse, 3),
                    Significant(score.persistence_rmse, 3), Significant(score.noise_floor, 3),
                    Significant(score.mae, 3), Fixed(score.r2, 3)});
    }
  }
  return table.Render();
}

}  // namespace

std::string MetricsTable(const Metrics& metrics) {
  return OneStepTable(metrics) + '\n' + FreeRunTable(metrics);
}

}  // namespace telltale
