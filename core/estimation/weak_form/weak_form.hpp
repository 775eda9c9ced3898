#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/regression/recording_bias_terms.hpp"
#include "telltale/core/estimation/regression/regression_problem.hpp"
#include "telltale/core/estimation/weak_form/test_function.hpp"
#include "telltale/core/estimation/weak_form/weak_form_options.hpp"
#include "telltale/core/vessel/regressors.hpp"

namespace telltale {

/// The supports of one equation's test functions, as rows of the dataset.
struct TestFunctionSupports {
  std::vector<std::size_t> first_rows;  ///< of each support, ascending
  std::vector<RowRange> clusters;       ///< of supports
};

/// The weak form of the equations of motion, docs/concepts/model.md (30):
///   -int phi'_k nu_j dt = int phi_k Phi_j(nu, T) dt theta_j + int phi_k d_j dt
/// It needs no differentiated velocity. Supports stay inside a segment and inside rows that enter
/// the equation. The propeller regressors T are those of the held commands: passed through the
/// thrusters' lag if there is one, averaged over each sampling interval, then filtered with the
/// kernel that made nu from positions.
/// Assumes: data prepared with the robust preset, which has one kernel.
struct WeakProblem {
  Parameterization parameterization = Parameterization::kUnknown;
  DeadZone dead_zone;
  RecordingBiasTerms recording_bias_terms;
  TestFunction phi;
  std::array<TestFunctionSupports, 3> supports;  ///< by equation
  std::size_t clusters = 0;
};

/// PreparedDataset -> WeakProblem. A cluster is the same range of time in every equation.
/// Requires: data prepared with the robust preset, and the commands of every segment.
WeakProblem BuildWeakForm(const PreparedDataset& dataset, const RegressionOptions& regression,
                          const WeakFormOptions& options);

}  // namespace telltale
