#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/effects/augmented_model.hpp"
#include "telltale/core/identification/identification.hpp"
#include "telltale/core/identification/physical_model.hpp"
#include "telltale/core/validation/scores.hpp"
#include "telltale/core/vessel/vessel_model.hpp"

namespace telltale {

inline constexpr double kLongestHorizonS = 600.0;

struct ValidationOptions {
  std::vector<double> horizons_s = {1.0, 5.0, 10.0};  ///< each [2 h, kLongestHorizonS]

  /// The first horizon that data of this sampling period do not allow; none where they allow all.
  std::optional<double> HorizonOutOfRange(double sampling_period_s) const;
};

/// 1, 5 and 10 s, as far as data of this sampling period allow them.
ValidationOptions UsualOptions(double sampling_period_s);

struct Metrics {
  std::array<OneStepScore, 3> one_step;  ///< surge, sway, yaw
  std::vector<FreeRunScores> free_run;
};

/// Scores a model on a dataset, docs/concepts/model.md (16)..(18).
/// One step: nu(k+1) from the measured nu(k). Free run: consecutive runs inside segments that start
/// from the measured state and follow the commands alone. Each run steps the model as it is
/// discretised (Advance); runs share no compared instant. A horizon that fits nowhere has
/// windows = 0.
/// Refuses when: the dataset has no pair of rows, a discrete model's sampling period is not the
/// data's, or a horizon is out of range.
/// Source: the paper's R2 and MAE equations.
Result<Metrics> Validate(const PreparedDataset& dataset, const VesselModel& model,
                         const ValidationOptions& options);

/// The same for the physical form. A free run starts from the state that the filter of the model
/// makes of the readings until then: velocities through the water, current, misalignment of the
/// compass and disturbance, which decays. What it predicts are the readings: velocities over ground
/// in the axes of the compass, positions as late as the fixes are.
Result<Metrics> Validate(const PreparedDataset& dataset, const PhysicalModel& model,
                         const ValidationOptions& options);

/// The same for an identified model: its physical form where it has one, else its coefficients,
/// without effects that were added to them.
/// Refuses when: an equation is missing.
Result<Metrics> Validate(const PreparedDataset& dataset, const Identification& identification,
                         const ValidationOptions& options);

/// The same for a model with effects, which act on the boat and on its sensors.
Result<Metrics> Validate(const PreparedDataset& dataset, const AugmentedModel& model,
                         const ValidationOptions& options);

/// The free-run scores that Validate has of one horizon. It spares the score one step ahead, which
/// takes most of the time with the physical form.
/// Refuses when: as Validate.
Result<FreeRunScores> ScoreFreeRuns(const PreparedDataset& dataset,
                                    const Identification& identification, double horizon_s);

/// One free run: predicted[k] stands for row first_row + k of the dataset; predicted[0] is where
/// the run starts. Of a prediction only time_s, eta and nu are set.
struct FreeRun {
  std::size_t first_row = 0;
  std::vector<PreparedRow> predicted;
};

/// The free runs that Validate scores, one after the other. A horizon of one sampling period gives
/// its one-step predictions.
/// Refuses when: as Validate; a horizon of one sampling period is allowed.
Result<std::vector<FreeRun>> FreeRunsOf(const PreparedDataset& dataset, const AugmentedModel& model,
                                        double horizon_s);
Result<std::vector<FreeRun>> FreeRunsOf(const PreparedDataset& dataset, const PhysicalModel& model,
                                        double horizon_s);

}  // namespace telltale
