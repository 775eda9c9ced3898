#pragma once

#include <vector>

#include <Eigen/Core>

#include "telltale/core/diagnosis/diagnosis.hpp"
#include "telltale/core/diagnosis/hypotheses/diagnosis_problem.hpp"
#include "telltale/core/diagnosis/hypotheses/power.hpp"
#include "telltale/core/diagnosis/hypotheses/present_weather.hpp"
#include "telltale/core/effects/effect.hpp"

namespace telltale {

/// The smallest size of each parameter that does not shape, with the others at their prior means,
/// that this recording, model and references show with kDiagnosis.testability.power beside the
/// weather; of either sign where the range has both. None for a stochastic effect. `scale`: of
/// NoiseFloor; `nominal_gain`: of NominalGains. Assumes: errors are normal, no fault hides what the
/// effect does to them, and no other effect does the same.
std::vector<DetectableSize> DetectableSizesOf(const Effect& effect, const DiagnosisProblem& problem,
                                              const PresentWeather& weather,
                                              const Eigen::VectorXd& scale, const DayToDay& days,
                                              double nominal_gain);

}  // namespace telltale
