#pragma once

#include <array>

#include <Eigen/Core>

#include "telltale/core/diagnosis/residuals/free_runs.hpp"
#include "telltale/core/diagnosis/residuals/spectral_peak.hpp"

namespace telltale {

/// Mean over windows of the outer product of the errors that an acceleration of one frequency and
/// random phase leaves, per squared amplitude, for each axis: surge, sway, yaw.
using ResponseMoments = std::array<Eigen::MatrixXd, 3>;

/// Model: the mean over the phases of cos and sin, from small accelerations that stay linear.
/// `errors` are those of the boat itself.
ResponseMoments ResponseMomentsAt(double frequency_rad_s, const FreeRuns& runs,
                                  const AugmentedModel& boat, const Eigen::MatrixXd& errors);

/// The mean of those moments over the frequencies of a log-normal peak about this one.
ResponseMoments MeanResponseMomentsOf(double frequency_rad_s, double log_width,
                                      const FreeRuns& runs, const AugmentedModel& boat,
                                      const Eigen::MatrixXd& errors);

/// The covariance that accelerations of these squared amplitudes, one an axis, add to a window's
/// errors. Shapes: rows x rows.
Eigen::MatrixXd ErrorCovarianceBy(const ResponseMoments& moments,
                                  const Eigen::Vector3d& squared_amplitudes);

}  // namespace telltale
