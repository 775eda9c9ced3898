#pragma once

#include <vector>

#include <Eigen/Core>

#include "telltale/core/estimation/weak_form/projected_equations.hpp"
#include "telltale/core/estimation/weak_form/weak_fit.hpp"
#include "telltale/core/vessel/disturbance.hpp"

namespace telltale {

/// The constant disturbance of each recording that these coefficients describe. All are zero where
/// the recordings share the regressor "1".
std::vector<ConstantDisturbance> ConstantDisturbancesWith(const WeakProblem& problem,
                                                          const ProjectedEquations& equations,
                                                          const Thetas& thetas);

/// The same of stacked unknowns of a fit.
std::vector<ConstantDisturbance> ConstantDisturbancesOf(const WeakFit& fit,
                                                        const Eigen::VectorXd& theta);

}  // namespace telltale
