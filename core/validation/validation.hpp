#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "data/prepared_dataset.hpp"
#include "result.hpp"
#include "vessel/vessel_model.hpp"

namespace telltale {

/// One-step score of one velocity, the paper's R2 and MAE, beside the R2 of predicting no change.
struct OneStepScore {
  double r2 = 0.0;
  double mae = 0.0;            ///< m/s or rad/s
  double persistence_r2 = 0.0;
};

/// Free-run score of one velocity over one horizon.
struct FreeRunScore {
  double rmse = 0.0;              ///< m/s or rad/s, over all instants of all windows
  double mae = 0.0;
  double r2 = 0.0;
  double persistence_rmse = 0.0;  ///< holding the initial velocity
  double noise_floor = 0.0;       ///< RMS of what smoothing removes: no model can be seen to do better
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
/// non-overlapping windows inside stretches, started from the measured state, fed only commands.
/// docs/model.md (16)..(18). Source: the paper's R2 and MAE equations.
/// Refuses when: the dataset has no pair of rows. A horizon that fits no window has windows = 0.
Result<Metrics> Validate(const PreparedDataset& dataset, const VesselModel& model,
                         const ValidationOptions& options);

}  // namespace telltale
