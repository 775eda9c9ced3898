#include "telltale/core/validation/structure_choice.hpp"

#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

#include "telltale/core/base/format_number.hpp"
#include "telltale/core/base/parallel.hpp"
#include "telltale/core/data/recording_parts.hpp"
#include "telltale/core/data/sampling_grid.hpp"
#include "telltale/core/identification/identify.hpp"
#include "telltale/core/validation/promotion.hpp"

namespace telltale {
namespace {

constexpr double kClearlyBetter = 0.7;
// Of the error of constant velocity.
constexpr double kPredicts = 0.5;
constexpr double kLittleToGain = 0.1;
constexpr std::size_t kFewestWindows = 10;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Recording LastPart(const Recording& recording, std::size_t most_fixes) {
  if (recording.gnss.size() <= most_fixes) return recording;
  return Between(recording, recording.gnss[recording.gnss.size() - most_fixes].time_s, kInfinity);
}

/// The geometric mean of errors over those of constant velocity; infinite where there is none.
double ErrorOverConstantVelocity(const std::optional<HeldOutScore>& score) {
  if (!score) return kInfinity;
  double sum = 0.0;
  int counted = 0;
  const FreeRunScores& scores = score->metrics.free_run.front();
  for (std::size_t i = 0; i < scores.velocity.size(); ++i) {
    const FreeRunScore& velocity = scores.velocity[i];
    if (!CountsInFreeRuns(i, velocity)) continue;
    sum += std::log(velocity.rmse / velocity.constant_velocity_rmse);
    ++counted;
  }
  const double mean = std::exp(sum / counted);
  return counted > 0 && std::isfinite(mean) ? mean : kInfinity;
}

std::string ErrorText(double error) {
  return std::isfinite(error) ? FormatNumber(error, 2) + " of constant velocity"
                              : "more than can be scored";
}

bool ShowsEnough(const std::optional<HeldOutScore>& score) {
  return score && score->metrics.free_run.front().windows >= kFewestWindows;
}

/// Whether so many free runs may fit into the part that is held out. A run is as long as its
/// horizon to half a sampling period.
bool CanShowEnough(const Recording& recording) {
  constexpr double kShortestRunS = HeldOutOptions{}.horizon_s - 0.5 * kLongestPeriodS;
  return HeldOutSpan(recording) >= kFewestWindows * kShortestRunS;
}

std::optional<HeldOutScore> ScoreOfFreeCoefficients(const Recording& part, const Vehicle& vehicle,
                                                    const IdentifyOptions& options,
                                                    const Progress& progress) {
  if (!CanShowEnough(part)) return std::nullopt;
  if (progress) progress("scoring free coefficients", 0.0);
  return OptionalOf(ScoreOnHeldOutPart(part, vehicle, options));
}

/// The physical form on trial: its score, and its model of all data where that was made beside.
struct PhysicalTrial {
  std::optional<HeldOutScore> score;
  std::optional<Result<Identification>> model;
};

PhysicalTrial TryPhysicalForm(const Recording& recording, const Recording& part,
                              const Vehicle& vehicle, IdentifyOptions options,
                              const Progress& progress) {
  options.regression.structure = Structure::kFossen;
  // Several recordings share the threads among them.
  const bool has_idle_thread = options.threads > 1 && recording.starts_s.size() < 2;
  PhysicalTrial trial;
  ForEachIndex(has_idle_thread ? 2 : 1, options.threads, [&](std::size_t i) {
    if (i == 0) {
      trial.score = OptionalOf(ScoreOnHeldOutPart(part, vehicle, options));
    } else {
      trial.model = Identify(recording, vehicle, options, progress);
    }
  });
  return trial;
}

/// The model of all data, where it was not made beside a score made now.
Result<Identification> ModelOfAllData(std::optional<Result<Identification>> beside,
                                      const Recording& recording, const Vehicle& vehicle,
                                      const IdentifyOptions& options, const Progress& progress) {
  return beside ? *std::move(beside) : Identify(recording, vehicle, options, progress);
}

Result<ScoredModel> IdentifyPhysicalForm(const Recording& recording, const Vehicle& vehicle,
                                         const IdentifyOptions& options, const Progress& progress) {
  if (progress) progress("scoring the physical form", 0.0);
  PhysicalTrial physical = TryPhysicalForm(recording, recording, vehicle, options, progress);
  auto identification =
      ModelOfAllData(std::move(physical.model), recording, vehicle, options, progress);
  if (!identification) return tl::unexpected(identification.error());
  return ScoredModel{*std::move(identification), std::move(physical.score)};
}

}  // namespace

StructureChoice ChooseStructure(const Recording& recording, const Vehicle& vehicle,
                                const IdentifyOptions& options, const Progress& progress) {
  const Recording part = LastPart(recording, HeldOutOptions{}.most_fixes);
  const auto free = ScoreOfFreeCoefficients(part, vehicle, options, progress);
  const double error = ErrorOverConstantVelocity(free);
  const std::string errors = "since over data set aside they err by " + ErrorText(error);
  if (ShowsEnough(free) && error < kLittleToGain) {
    return {options.regression.structure, "free coefficients, " + errors, *free, {}};
  }
  if (progress) progress("scoring the physical form", 0.3);
  PhysicalTrial physical = TryPhysicalForm(recording, part, vehicle, options, progress);
  const double physical_error = ErrorOverConstantVelocity(physical.score);
  if (ShowsEnough(free) && error < kPredicts && error < kClearlyBetter * physical_error) {
    return {options.regression.structure,
            "free coefficients, " + errors + ", the physical form by " + ErrorText(physical_error),
            *free,
            {}};
  }
  const std::string reason =
      ShowsEnough(free) ? "since over data set aside it errs by " + ErrorText(physical_error) +
                              ", free coefficients by " + ErrorText(error)
                        : "since the recording is too short to show that it lacks "
                          "something";
  return {Structure::kFossen, "physical form, " + reason, std::move(physical.score),
          std::move(physical.model)};
}

Result<ScoredModel> IdentifyInGivenStructure(const Recording& recording, const Vehicle& vehicle,
                                             const IdentifyOptions& options,
                                             const Progress& progress) {
  if (options.regression.structure == Structure::kFossen) {
    return IdentifyPhysicalForm(recording, vehicle, options, progress);
  }
  auto identification = Identify(recording, vehicle, options, progress);
  if (!identification) return tl::unexpected(identification.error());
  if (progress) progress("scoring on the part that is held out", 0.0);
  auto score = OptionalOf(ScoreOnHeldOutPart(recording, vehicle, *identification, options));
  return ScoredModel{*std::move(identification), std::move(score)};
}

Result<ScoredModel> IdentifyInChosenStructure(const Recording& recording, const Vehicle& vehicle,
                                              const IdentifyOptions& free_options,
                                              const Progress& progress) {
  StructureChoice choice = ChooseStructure(recording, vehicle, free_options, progress);
  IdentifyOptions options = free_options;
  options.regression.structure = choice.structure;
  auto identification =
      ModelOfAllData(std::move(choice.physical), recording, vehicle, options, progress);
  if (!identification && choice.structure == Structure::kFossen) {
    choice.reason =
        "free coefficients, since of the physical form " + identification.error().reason;
    choice.score.reset();
    identification = Identify(recording, vehicle, free_options, progress);
  }
  if (!identification) return tl::unexpected(identification.error());
  identification->provenance.structure_choice = std::move(choice.reason);
  return ScoredModel{*std::move(identification), std::move(choice.score)};
}

}  // namespace telltale
