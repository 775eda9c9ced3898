#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/diagnosis/residuals/frequency_response.hpp"

namespace telltale {

/// Covariance that accelerations of one frequency and random phase add to a window's errors: the
/// sum over axes of squared amplitude times response moment. Shapes: rows x rows.
Eigen::MatrixXd ExcessCovariance(const Eigen::Vector3d& squared_amplitudes,
                                 const ResponseMoments& moments);

/// Windows of whitened errors whose covariance is the identity plus an ExcessCovariance.
struct ScatterFit {
  Eigen::Vector3d squared_amplitudes = Eigen::Vector3d::Zero();
  Eigen::VectorXd log_likelihood_ratios;  ///< 2 ln over no excess, by window
  double square = 0.0;  ///< squared Mahalanobis distance of all windows by that covariance
};

/// The most likely squared amplitudes, by the multiplicative form of Fisher scoring, which keeps
/// them positive. Shapes: rows x windows; moments rows x rows, whitened like the windows.
ScatterFit FitScatter(const Eigen::MatrixXd& windows, const ResponseMoments& moments);

/// The number of values times the lower quartile of their means by block, so that three blocks of
/// four have more. A gain that only a few blocks have does not count. Shapes: one value and one
/// block number a window.
double PersistentSum(const Eigen::VectorXd& values, const std::vector<std::size_t>& blocks);

}  // namespace telltale
