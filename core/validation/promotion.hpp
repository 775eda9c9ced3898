#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "telltale/core/data/samples.hpp"
#include "telltale/core/identification/identify.hpp"
#include "telltale/core/validation/held_out_score.hpp"
#include "telltale/core/validation/validation.hpp"
#include "telltale/core/vessel/motion.hpp"
#include "telltale/core/vessel/vehicle.hpp"

namespace telltale {

/// What a model is good for, before it replaces another.
/// kOk: nothing speaks against it. kWarn: it predicts a velocity no better than constant velocity,
/// cannot be simulated for long, or lacks an equation. kError: it diverges within 5 s, or predicts
/// no velocity better than constant velocity.
enum class PromotionVerdict { kUnknown, kOk, kWarn, kError };

std::string_view Name(PromotionVerdict verdict);

/// The verdict of this name; kUnknown where there is none.
PromotionVerdict PromotionVerdictNamed(std::string_view name);

struct Promotion {
  PromotionVerdict verdict = PromotionVerdict::kUnknown;
  std::string reason;  ///< for people, without the subject; empty where the verdict is kOk

  bool operator==(const Promotion&) const = default;
};

/// Whether a velocity (0 surge, 1 sway, 2 yaw) tells of a model: where constant velocity errs by
/// more than 0.1 m/s or 0.05 rad/s. Below that the noise of the sensors decides which is better.
bool CountsInFreeRuns(std::size_t velocity, const FreeRunScore& score);

/// The verdict by scores of 5 s free runs.
/// `own`: of the model over its own data; it diverges where an error exceeds `limits`, m/s and
/// rad/s. `held_out`: of a model made from the first part of the data, over the rest, in
/// the velocities that count there.
Promotion PromotionByScores(const FreeRunScores& own, const Nu& limits,
                            const std::optional<HeldOutScore>& held_out);

/// The verdict on a model that was made from this recording with these options. `held_out`: the
/// score over 5 s of a model that was made alike from the first part of the recording, such as
/// IdentifyInChosenStructure() gives. Where no score can be measured, the data speak neither for
/// nor against the model, and the verdict is kOk.
Promotion AssessPromotion(const Recording& recording, const Vehicle& vehicle,
                          const Identification& identification, const IdentifyOptions& options,
                          const std::optional<HeldOutScore>& held_out);

/// The same, and measures the score, which costs a second identification without bounds.
Promotion AssessPromotion(const Recording& recording, const Vehicle& vehicle,
                          const Identification& identification, const IdentifyOptions& options);

}  // namespace telltale
