#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/effects/augmented_model.hpp"
#include "telltale/core/vessel/vessel_model.hpp"

namespace telltale {

/// One-step score of one velocity, the paper's R2 and MAE, beside the R2 of predicting no change.
/// Any R2 is NaN when the measured velocity never changes.
struct OneStepScore {
  double r2 = 0.0;
  double mae = 0.0;  ///< m/s or rad/s
  double constant_velocity_r2 = 0.0;
};

/// Free-run score of one velocity over one horizon, over all instants after the first of all
/// windows. A model that blows up within a window scores infinite errors. The noise floor is
/// PreparedDataset::nu_noise: measured velocities are themselves uncertain by that much, so errors
/// against them cannot be seen to be smaller. It is a lower bound: noise slower than white, the
/// uncertain start of a window and what smoothing does to true transients come on top.
struct FreeRunScore {
  double rmse = 0.0;  ///< m/s or rad/s
  double mae = 0.0;
  double r2 = 0.0;
  double constant_velocity_rmse = 0.0;  ///< holding the initial velocity
  double noise_floor = 0.0;             ///< one sigma of the measured velocity
};

struct FreeRunScores {
  double horizon_s = 0.0;
  std::array<FreeRunScore, 3> velocity;  ///< surge, sway, yaw
  double position_rmse_m = 0.0;          ///< at the end of the horizon
  std::size_t windows = 0;
};

struct ValidationOptions {
  std::vector<double> horizons_s = {1.0, 5.0, 10.0};  ///< each [2 h, 600]
};

struct Metrics {
  std::array<OneStepScore, 3> one_step;  ///< surge, sway, yaw
  std::vector<FreeRunScores> free_run;
};

/// PreparedDataset x model -> scores. One-step: nu(k+1) from the measured nu(k). Free run:
/// non-overlapping windows inside segments, started from the measured state, fed only commands.
/// Each run steps the model as the model is discretised (Advance); windows share no compared
/// instant. docs/concepts/model.md (16)..(18). Source: the paper's R2 and MAE equations. Refuses
/// when: the dataset has no pair of rows, a discrete model's sampling period is not the data's, a
/// horizon is out of range. A horizon that fits no window has windows = 0.
Result<Metrics> Validate(const PreparedDataset& dataset, const VesselModel& model,
                         const ValidationOptions& options);

/// The same of a model with effects: they act on the boat and on what its sensors say of it.
Result<Metrics> Validate(const PreparedDataset& dataset, const AugmentedModel& model,
                         const ValidationOptions& options);

}  // namespace telltale
