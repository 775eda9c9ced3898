#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/regression/recording_bias_terms.hpp"
#include "telltale/core/estimation/regression/regression_problem.hpp"
#include "telltale/core/vessel/body_regressors.hpp"
#include "telltale/core/vessel/model_structure.hpp"

namespace telltale {

/// How the equations of motion are weighed over time. Lengths are in seconds; a test function spans
/// at least five sampling periods to each side of its centre whatever they say.
struct WeakFormOptions {
  double half_support_s = 2.0;       ///< of a test function, T
  double spacing_s = 1.0;            ///< of neighbouring test functions
  double longest_cluster_s = 20.0;   ///< windows centred within this length count as one cluster,
  double shortest_cluster_s = 8.0;   ///< less, down to this,
  std::size_t wanted_clusters = 80;  ///< where that gives fewer clusters than these
};

/// A row per dataset row and a column per regressor, row-major as it is filled and weighed by rows.
using RegressorRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// The test function phi(t) = (1 - (t/T)^2)^6 and its slope on the sampling grid, with the weights
/// of the sum that stands for the integral: both vanish with five derivatives at the ends, so the
/// sum is as good as exact.
struct TestFunction {
  Eigen::VectorXd value;   ///< phi(t_i) h
  Eigen::VectorXd slope;   ///< phi'(t_i) h
  std::size_t stride = 1;  ///< rows between neighbouring windows

  std::size_t Rows() const { return static_cast<std::size_t>(value.size()); }

  static TestFunction On(double sampling_period_s, const WeakFormOptions& options);
};

/// Windows of rows on which one equation is weighed: first row of each, ascending, and by cluster.
struct TestFunctionSupports {
  std::vector<std::size_t> first_rows;
  std::vector<RowRange> clusters;
};

/// The weak form of the equations of motion, docs/concepts/model.md (30):
///   -int phi'_k nu_j dt = int phi_k Phi_j(nu, T) dt theta_j + int phi_k d_j dt
/// No acceleration is ever differentiated out. Windows stay inside a segment and inside rows that
/// enter the equation. The propeller regressors T are those of the held commands, passed through
/// the thrusters' lag if there is one, averaged over each sampling interval and then filtered with
/// the very kernel that made nu from positions.
/// Requires of the dataset: the robust preset, whose kernel is one.
struct WeakProblem {
  Parameterization parameterization = Parameterization::kUnknown;
  DeadZone dead_zone;
  RecordingBiasTerms disturbance_terms;
  TestFunction phi;
  std::array<TestFunctionSupports, 3> supports;
  std::size_t clusters = 0;
  std::vector<BodyRow> bodies;  ///< by dataset row, less what noise in nu adds on average
};

/// Rows to each side of the Savitzky-Golay filter that suit the weak form: as few as leave sway,
/// the quietest of the velocities, half as noisy as it is lively, but at least 0.8 s, and 1.6 s
/// from a quarter of an hour on. The noisier a velocity the weaker the instruments of its products;
/// the wider the filter the more is lost of products, which is made good as far as the model
/// foretells it, and of windows, which short recordings cannot spare. `preview`: the same recording
/// prepared with any width.
std::size_t SmoothingFor(const PreparedDataset& preview);

/// PreparedDataset -> WeakProblem. Clusters are the same segment of time in every equation.
WeakProblem BuildWeakForm(const PreparedDataset& dataset, const RegressionOptions& regression,
                          const WeakFormOptions& options);

/// The propeller regressors of every row, as the velocities see them. time_constant_s unset or
/// zero: thrust at once.
struct FilteredThrust {
  std::vector<ThrustRegressors> interval;  ///< mean over [t_k, t_k + h)
  std::vector<ThrustRegressors> filtered;  ///< weighed over intervals as nu_k is over velocities
};

FilteredThrust FilterThrust(const PreparedDataset& dataset, const WeakProblem& problem,
                            std::optional<double> time_constant_s);

/// The filter F of the dataset away from the ends of a segment: the weights with which the mean
/// velocities of the intervals about a row make its velocity.
Eigen::VectorXd FilterOnIntervals(const PreparedDataset& dataset);

/// phi through F: the weights with which accelerations, by interval, enter a window. The first is
/// that of the interval half a filter before the window's first row.
Eigen::VectorXd FilteredTestFunction(const Eigen::VectorXd& filter, const TestFunction& phi);

/// Rows Phi_j(nu_k, T_k) of one equation, of the problem's bodies, and after them its
/// RecordingBiasTerms.
RegressorRows RowsOf(const PreparedDataset& dataset, const WeakProblem& problem,
                     const FilteredThrust& thrust, Equation equation);

/// int phi_k x dt by window, of every column of x.
Eigen::MatrixXd Project(const WeakProblem& problem, const TestFunctionSupports& supports,
                        const RegressorRows& rows);

/// -int phi'_k nu_j dt by window.
Eigen::VectorXd ProjectAcceleration(const WeakProblem& problem,
                                    const TestFunctionSupports& supports,
                                    const PreparedDataset& dataset, Equation equation);

}  // namespace telltale
