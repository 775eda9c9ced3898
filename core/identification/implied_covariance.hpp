#pragma once

#include <functional>

#include <Eigen/Core>

#include "telltale/core/vessel/fossen_model.hpp"

namespace telltale {

/// The covariance of what physical parameters imply, given theirs, by the delta method. Forward
/// differences of a thousandth of a standard error, which stay within the physical range.
/// Parameters of variance zero do not vary.
Eigen::MatrixXd ImpliedCovariance(
    const FossenVector& about, const Eigen::MatrixXd& covariance,
    const std::function<Eigen::VectorXd(const FossenVector&)>& implied);

}  // namespace telltale
