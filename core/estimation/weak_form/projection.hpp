#pragma once

#include <Eigen/Core>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/weak_form/filtered_thrust.hpp"
#include "telltale/core/estimation/weak_form/weak_form.hpp"

namespace telltale {

/// A row per instant and a column per regressor. It is row-major because it is filled and projected
/// by rows.
using RegressorRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// int phi_k Phi_j(nu, T) dt of every regressor of one equation, then of its RecordingBiasTerms;
/// nu less the mean that its noise adds to Phi.
/// Shapes: supports x columns. Memory beside the result: the rows of one segment.
Eigen::MatrixXd ProjectRegressors(const PreparedDataset& dataset, const WeakProblem& problem,
                                  const FilteredThrust& thrust, Equation equation);

/// -int phi'_k nu_j dt, one value per support.
Eigen::VectorXd ProjectAcceleration(const WeakProblem& problem,
                                    const TestFunctionSupports& supports,
                                    const PreparedDataset& dataset, Equation equation);

}  // namespace telltale
