#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/preparation.hpp"
#include "telltale/core/data/samples.hpp"
#include "telltale/core/estimation/regression/excitation.hpp"
#include "telltale/core/estimation/regression/regression_problem.hpp"
#include "telltale/core/estimation/weak_form/weak_iv.hpp"
#include "telltale/core/identification/identification.hpp"
#include "telltale/core/uncertainty/bootstrap.hpp"
#include "telltale/core/vessel/vehicle.hpp"
#include "telltale/core/vessel/vessel_model.hpp"

namespace telltale {

/// Called as an identification advances: what is being done, and how far it is in [0, 1].
using Progress = std::function<void(std::string_view stage, double fraction)>;

/// Where the limits of the dead zone come from. kGiven: regression.dead_zone as it stands.
/// kIdentified: from the data, EstimateDeadZone(); limits the data cannot tell keep what is given.
enum class DeadZoneSource { kUnknown, kGiven, kIdentified };

std::string_view Name(DeadZoneSource source);

struct IdentifyOptions {
  PrepareOptions prepare;
  RegressionOptions regression;
  DeadZoneSource dead_zone_source = DeadZoneSource::kGiven;
  ExcitationLimits excitation;
  /// Unset: output error where the data show no disturbance, weak-form IV where they do or may.
  std::optional<Estimator> estimator = std::nullopt;
  WeakIvOptions weak_iv;  ///< of kWeakIv, and of what output error starts from
  std::size_t parametric_replicates =
      40;                        ///< simulated repeats behind the bounds of kWeakIv, 0 or [8, 1000]
  double interval_level = 0.95;  ///< (0.5, 0.999]
  std::size_t bootstrap_replicates = 1000;                       ///< 0 (off) or [100, 100000]
  Resampling resampling = Resampling::kSlices;                   ///< what a replicate redraws
  IntervalMethod interval_method = IntervalMethod::kPercentile;  ///< how replicates bound
  std::uint64_t seed = 1;
  std::size_t threads = 1;  ///< [1, 256]; never changes the result
  bool advise = true;       ///< work out which manoeuvres would tell what the data leave open
  /// Simulated repeats on which the bounds are measured, 0 (none) or [10, 1000]; each costs as much
  /// as the identification itself.
  std::size_t coverage_check_replicates = 0;

  /// The paper's estimator in place of the default.
  static IdentifyOptions OneStep();

  /// The first field out of its range, as a refusal naming field, value and range.
  std::optional<Refusal> Validate() const;
};

/// Recording -> Identification: prepare, build the regressions, assess excitation, estimate,
/// quantify. Refuses when: the recording cannot be prepared, or not one equation can be answered.
/// An equation that alone cannot be answered is left out and its refusal listed in the result, as
/// is that of a certificate.
Result<Identification> Identify(const Recording& recording, const Vehicle& vehicle,
                                const IdentifyOptions& options, const Progress& progress = {});

/// The same from data that are prepared already; but for kOneStep as PrepareForWeakIv does, in
/// segments of a minute or so and with a narrow filter. There is no certificate, which takes a
/// recording.
Result<Identification> Identify(const PreparedDataset& dataset, const std::string& vehicle_id,
                                const IdentifyOptions& options, const Progress& progress = {});

/// ModelOf the same identification without the cost of its bounds; the dead zone is as given.
/// Refuses when: an equation cannot be answered.
Result<VesselModel> EstimateModel(const PreparedDataset& dataset,
                                  const RegressionOptions& regression,
                                  const ExcitationLimits& limits = {});

}  // namespace telltale
