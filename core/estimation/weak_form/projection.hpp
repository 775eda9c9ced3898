#pragma once

#include <Eigen/Core>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/weak_form/filtered_thrust.hpp"
#include "telltale/core/estimation/weak_form/weak_form.hpp"

namespace telltale {

/// A row per dataset row and a column per regressor. It is row-major because it is filled and
/// projected by rows.
using RegressorRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Rows Phi_j(nu_k, T_k) of one equation, of the problem's bodies, then its RecordingBiasTerms.
RegressorRows RowsOf(const PreparedDataset& dataset, const WeakProblem& problem,
                     const FilteredThrust& thrust, Equation equation);

/// int phi_k x dt of every column of x. Shapes: rows as many as the dataset; the result supports x
/// columns.
Eigen::MatrixXd Project(const WeakProblem& problem, const TestFunctionSupports& supports,
                        const RegressorRows& rows);

/// -int phi'_k nu_j dt, one value per support.
Eigen::VectorXd ProjectAcceleration(const WeakProblem& problem,
                                    const TestFunctionSupports& supports,
                                    const PreparedDataset& dataset, Equation equation);

}  // namespace telltale
