#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/preparation.hpp"
#include "telltale/core/estimation/regression/excitation.hpp"
#include "telltale/core/estimation/regression/regression_problem.hpp"
#include "telltale/core/estimation/weak_form/weak_iv.hpp"
#include "telltale/core/identification/estimator.hpp"
#include "telltale/core/uncertainty/bootstrap.hpp"
#include "telltale/core/uncertainty/interval.hpp"

namespace telltale {

/// Where the limits of the dead zone come from. kGiven: regression.dead_zone. kIdentified:
/// EstimateDeadZone() of the data; a limit that the data do not determine stays as given.
enum class DeadZoneSource { kUnknown, kGiven, kIdentified };

std::string_view Name(DeadZoneSource source);

/// What to identify and how. Ranges stand in brackets; Validate() checks them.
struct IdentifyOptions {
  PrepareOptions prepare;
  RegressionOptions regression;
  DeadZoneSource dead_zone_source = DeadZoneSource::kGiven;
  ExcitationLimits excitation;
  /// Unset: output error where the data show no disturbance, weak-form IV otherwise.
  std::optional<Estimator> estimator = std::nullopt;
  WeakIvOptions weak_iv;  ///< of kWeakIv, and of the fit from which output error starts
  /// Parametric bootstrap replicates behind the bounds of kWeakIv, 0 or [8, 1000].
  std::size_t parametric_replicates = 40;
  double interval_level = 0.95;                 ///< (0.5, 0.999]
  std::size_t bootstrap_replicates = 1000;      ///< 0 (off) or [100, 100000]
  std::size_t posterior_draws = 2000;           ///< behind the bounds of kFossen, [100, 100000]
  Resampling resampling = Resampling::kSlices;  ///< what a replicate redraws
  IntervalMethod interval_method = IntervalMethod::kPercentile;  ///< from replicates to intervals
  std::uint64_t seed = 1;
  std::size_t threads = 1;  ///< [1, 256]; never changes the result
  bool advise = true;       ///< whether to search manoeuvres that narrow wide bounds
  /// Replicates of the coverage check by simulation, 0 (none) or [10, 1000]. Each takes as long as
  /// the identification.
  std::size_t coverage_check_replicates = 0;

  /// The defaults with the paper's estimator.
  static IdentifyOptions OneStep();

  /// The first field out of its range, as a refusal naming field, value and range.
  std::optional<Refusal> Validate() const;
};

}  // namespace telltale
