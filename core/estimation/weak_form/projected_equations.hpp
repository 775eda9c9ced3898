#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/weak_form/instruments.hpp"
#include "telltale/core/estimation/weak_form/projection.hpp"
#include "telltale/core/vessel/vessel_model.hpp"

namespace telltale {

/// One equation projected onto its test functions: b = G theta + e.
/// Shapes: G supports x columns sought, b one value per support.
struct ProjectedEquation {
  std::size_t index = 0;             ///< in kEquations
  std::vector<std::size_t> columns;  ///< of Regressors() and then RecordingBiasTerms
  Eigen::MatrixXd G;
  Eigen::VectorXd b;
};

using ProjectedEquations = std::vector<ProjectedEquation>;
using Thetas = std::vector<Eigen::VectorXd>;  ///< one for each of the ProjectedEquations

/// The equations with columns sought.
ProjectedEquations ProjectEquations(const PreparedDataset& dataset, const WeakProblem& problem,
                                    const FilteredThrust& thrust,
                                    const std::array<std::vector<std::size_t>, 3>& columns);

/// The derivative of G theta by the time constant, one column per equation, by central differences.
std::vector<Eigen::MatrixXd> LagDerivatives(const PreparedDataset& dataset,
                                            const WeakProblem& problem,
                                            const ProjectedEquations& equations,
                                            const Thetas& thetas, double time_constant_s);

/// Each equation by itself, by least squares.
Thetas SolveLeastSquares(const ProjectedEquations& equations);

/// An equation's instrumental-variable solution, shrunk along directions that Z'G hardly
/// determines. It predicts similar motion without the large coefficients that noise causes there.
/// `ridge` is relative to columns of unit norm.
Eigen::VectorXd SolveRegularised(const ProjectedEquation& equation, const Eigen::MatrixXd& Z,
                                 double ridge);

/// The norm of each column, never zero.
Eigen::VectorXd ColumnNorms(const Eigen::MatrixXd& columns);

/// A static model with these coefficients: the thrust that it is simulated with is already lagged.
VesselModel ModelWith(const WeakProblem& problem, const ProjectedEquations& equations,
                      const Thetas& thetas);

}  // namespace telltale
