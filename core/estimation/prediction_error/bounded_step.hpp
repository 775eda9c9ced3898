#pragma once

#include <Eigen/Core>

namespace telltale {

/// The step of damped normal equations from `z` that stays between `least` and `greatest`: an
/// unknown that would leave its range stops at the end of it, and the others are solved for anew.
/// `information` need not be symmetric; its diagonal counts 1 + `damping` times. Requires: z within
/// its range.
Eigen::VectorXd BoundedStep(const Eigen::VectorXd& z, const Eigen::VectorXd& least,
                            const Eigen::VectorXd& greatest, const Eigen::MatrixXd& information,
                            const Eigen::VectorXd& gradient, double damping);

}  // namespace telltale
