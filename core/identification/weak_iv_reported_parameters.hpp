#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/weak_form/weak_iv.hpp"
#include "telltale/core/identification/equation_estimates.hpp"
#include "telltale/core/identification/identification.hpp"

namespace telltale {

/// How the unknowns of a weak-form fit become those that are reported: the same, but where each
/// recording has steady terms of its own the regressor "1" gets the mean of their constants, and
/// the terms themselves follow after all coefficients.
/// Shapes: map reported x sought; columns places in Regressors().
struct ReportedParameters {
  struct Term {
    Equation equation = Equation::kUnknown;
    std::size_t recording = 0;
    std::size_t term = 0;    ///< as in RecordingBiasTermName()
    Eigen::Index place = 0;  ///< among the reported parameters
  };

  Eigen::MatrixXd map;
  std::array<std::vector<std::size_t>, 3> columns;
  std::vector<Term> terms;
};

ReportedParameters ReportedParametersOf(const WeakFit& fit);

/// The constant disturbance of each recording with its bounds; none where it is shared.
std::vector<RecordingBias> RecordingBiasesOf(const ReportedParameters& reported_parameters,
                                             const Eigen::VectorXd& reported, const Bounds& bounds,
                                             const PreparedDataset& dataset);

}  // namespace telltale
