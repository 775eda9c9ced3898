#pragma once

#include <Eigen/Core>

#include "telltale/core/diagnosis/baseline/nominal_baseline.hpp"

namespace telltale {

/// Expected log evidence, in nats, between two hypotheses that predict these free-run errors on a
/// nominal boat: n / 2 ln(1 + d' V^-1 d / (rows windows)), d their difference and n the effective
/// number of observations; docs/concepts/diagnosis.md (96). Shapes: rows x windows, rows those of
/// the baseline's covariance V.
double ExpectedSeparation(const Eigen::MatrixXd& one, const Eigen::MatrixXd& other,
                          const NominalBaseline& nominal);

}  // namespace telltale
