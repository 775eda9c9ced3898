#include "telltale/core/effects/recording_frame.hpp"

#include <algorithm>

#include "telltale/core/base/contract.hpp"

namespace telltale {

RecordingFrame RecordingFrameOf(const PreparedDataset& dataset) {
  Require(!dataset.rows.empty(), "a dataset with rows");
  RecordingFrame frame;
  frame.start_s = dataset.StartTime();
  frame.span_s = std::max(dataset.EndTime() - frame.start_s, 1.0);
  for (const PreparedRow& row : dataset.rows)
    frame.middle_m += Eigen::Vector2d(row.eta.x_m, row.eta.y_m);
  frame.middle_m /= static_cast<double>(dataset.rows.size());
  return frame;
}

}  // namespace telltale
