#pragma once

#include <Eigen/Core>

#include "inputs/reference_basis.hpp"

namespace blind::baselines {

/// Acceleration residuals of the recalibrated boat, as a regression sees them. Each is the mean
/// over one second that begins where the boat was measured to be, in what such misses are on the
/// reference recordings (root mean square by channel), less what regresses on effects there too.
/// Shapes: surge, sway and yaw stacked second by second; one column a parameter, what its typical
/// size would change.
struct Accelerations {
  Eigen::VectorXd residuals;
  Eigen::MatrixXd signatures;
  double independent = 0.0;  ///< misses there are, less for their correlation from one to the next
};

Accelerations AccelerationsOf(const ReferenceBasis& basis);

}  // namespace blind::baselines
