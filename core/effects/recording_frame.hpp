#pragma once

#include <Eigen/Core>

#include "telltale/core/data/prepared_dataset.hpp"

namespace telltale {

/// What effects that change with time or place count from: a recording's start and length, on the
/// clock of its commands, and the middle of its track, north and east.
struct RecordingFrame {
  double start_s = 0.0;
  double span_s = 1.0;  ///< > 0
  Eigen::Vector2d middle_m = Eigen::Vector2d::Zero();
};

/// That of a dataset; the middle is the mean over its rows. Requires: at least one row.
RecordingFrame RecordingFrameOf(const PreparedDataset& dataset);

}  // namespace telltale
