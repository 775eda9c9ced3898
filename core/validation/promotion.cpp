#include "telltale/core/validation/promotion.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

#include "telltale/core/base/format_number.hpp"
#include "telltale/core/data/preparation.hpp"
#include "telltale/core/simulation/divergence.hpp"

namespace telltale {
namespace {

constexpr double kHorizonS = 5.0;
constexpr std::size_t kMostFixes = 30000;

struct VelocityUnit {
  const char* name;
  const char* unit;
  double counts_from;  ///< error of constant velocity
};

constexpr std::array<VelocityUnit, 3> kVelocities = {
    {{"surge", "m/s", 0.1}, {"sway", "m/s", 0.1}, {"yaw", "rad/s", 0.05}}};

std::string Seconds(double duration_s) {
  return FormatNumber(duration_s, 0) + " s";
}

std::string HeldOutPart(const HeldOutScore& score) {
  return "the last " + Seconds(score.held_out_s) + ", predicted from the first " +
         Seconds(score.training_s);
}

std::string Errors(std::size_t velocity, const FreeRunScore& score) {
  const VelocityUnit& names = kVelocities[velocity];
  return std::string(names.name) + " errs by " + FormatNumber(score.rmse, 3) + ' ' + names.unit +
         " and constant velocity by " + FormatNumber(score.constant_velocity_rmse, 3);
}

Promotion ByHeldOutPart(const HeldOutScore& score) {
  const FreeRunScores& scores = score.metrics.free_run.front();
  std::size_t counted = 0;
  std::size_t worse = 0;
  std::string errors;
  for (std::size_t i = 0; i < kVelocities.size(); ++i) {
    const FreeRunScore& velocity = scores.velocity[i];
    if (!CountsInFreeRuns(i, velocity)) continue;
    ++counted;
    if (velocity.rmse < velocity.constant_velocity_rmse) continue;
    ++worse;
    errors += (errors.empty() ? "" : ", ") + Errors(i, velocity);
  }
  if (worse == 0) return {PromotionVerdict::kOk, ""};
  return {
      worse == counted ? PromotionVerdict::kError : PromotionVerdict::kWarn,
      "it predicts no better than constant velocity over " + HeldOutPart(score) + ": " + errors};
}

/// Identify() warns where the model diverges over its own recording and no regularised parameters
/// mend that.
bool CannotBeSimulatedForLong(const Identification& identification) {
  return identification.simulation.empty() &&
         std::ranges::any_of(identification.refusals,
                             [](const Refusal& refusal) { return refusal.subject == "free run"; });
}

PromotionVerdict Worse(PromotionVerdict one, PromotionVerdict other) {
  return std::max(one, other);
}

}  // namespace

std::string_view Name(PromotionVerdict verdict) {
  switch (verdict) {
    case PromotionVerdict::kUnknown: return "UNKNOWN";
    case PromotionVerdict::kOk: return "OK";
    case PromotionVerdict::kWarn: return "WARN";
    case PromotionVerdict::kError: return "ERROR";
  }
  return "";
}

PromotionVerdict PromotionVerdictNamed(std::string_view name) {
  for (const auto verdict :
       {PromotionVerdict::kOk, PromotionVerdict::kWarn, PromotionVerdict::kError}) {
    if (Name(verdict) == name) return verdict;
  }
  return PromotionVerdict::kUnknown;
}

bool CountsInFreeRuns(std::size_t velocity, const FreeRunScore& score) {
  return score.constant_velocity_rmse > kVelocities[velocity].counts_from;
}

Promotion PromotionByScores(const FreeRunScores& own, const Nu& limits,
                            const std::optional<HeldOutScore>& held_out) {
  if (own.windows > 0 && Diverges(own, limits)) {
    return {PromotionVerdict::kError,
            "it diverges in free runs of " + Seconds(own.horizon_s) + " over its own data"};
  }
  if (!held_out) return {PromotionVerdict::kOk, ""};
  const FreeRunScores& scores = held_out->metrics.free_run.front();
  if (Diverges(scores, limits)) {
    return {PromotionVerdict::kError, "it diverges in free runs of " + Seconds(scores.horizon_s) +
                                          " over " + HeldOutPart(*held_out)};
  }
  return ByHeldOutPart(*held_out);
}

Promotion AssessPromotion(const Recording& recording, const Vehicle& vehicle,
                          const Identification& identification, const IdentifyOptions& options,
                          const std::optional<HeldOutScore>& held_out) {
  const auto model = ModelOf(identification);
  if (!model) return {PromotionVerdict::kWarn, model.error().reason};
  PrepareOptions prepare = options.prepare;
  prepare.sampling_period_s = identification.sampling_period_s;
  const auto dataset = Prepare(recording, vehicle, prepare);
  if (!dataset) return {PromotionVerdict::kOk, ""};
  const auto own = ScoreFreeRuns(*dataset, identification, kHorizonS);
  if (!own) return {PromotionVerdict::kOk, ""};
  Promotion promotion =
      PromotionByScores(*own, kFreeRunDivergence.LimitsFor(FastestOf(*dataset)), held_out);
  if (CannotBeSimulatedForLong(identification)) {
    promotion.verdict = Worse(promotion.verdict, PromotionVerdict::kWarn);
    promotion.reason += std::string(promotion.reason.empty() ? "" : "; ") +
                        "simulated over its whole data it diverges";
  }
  return promotion;
}

Promotion AssessPromotion(const Recording& recording, const Vehicle& vehicle,
                          const Identification& identification, const IdentifyOptions& options) {
  const auto held_out = ScoreOnHeldOutPart(recording, vehicle, identification, options,
                                           {.horizon_s = kHorizonS, .most_fixes = kMostFixes});
  return AssessPromotion(recording, vehicle, identification, options, OptionalOf(held_out));
}

}  // namespace telltale
