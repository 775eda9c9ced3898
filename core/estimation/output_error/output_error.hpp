#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/output_error/separability.hpp"
#include "telltale/core/estimation/output_error/shared_unknowns.hpp"
#include "telltale/core/estimation/output_error/shooting_plan.hpp"
#include "telltale/core/estimation/regression/regression_problem.hpp"
#include "telltale/core/vessel/vessel_model.hpp"

namespace telltale {

struct OutputErrorOptions {
  ShootingOptions shooting_segments;
  double huber_threshold = 3.0;  ///< in standard deviations of the residuals; [1, 100]
  double inseparable_condition_index = 1000.0;  ///< of the information matrix; [10, 1e6]
  int iterations = 100;  ///< at most, of each descent after the rough one; [1, 1000]

  /// The first field out of its range, as a refusal naming field, value and range.
  std::optional<Refusal> Validate() const;
};

/// Shapes, with P the shared unknowns as SharedUnknowns stacks them and g clusters: theta P;
/// information P x P, the Schur complement H of the initial states; scores P x g, q_s = -J'r over
/// the shooting segments of cluster s after the same elimination. To first order
/// theta - truth = H^-1 sum_s q_s.
struct OutputErrorFit {
  SharedUnknowns unknowns;
  Eigen::VectorXd theta;
  Eigen::VectorXd begin;              ///< initial theta, the centre of the ridge prior
  std::vector<ShootingState> starts;  ///< initial states of the shooting segments
  Eigen::MatrixXd information;
  Eigen::MatrixXd scores;
  std::vector<Eigen::MatrixXd> cluster_information;  ///< sum: information
  Separability separability;
  /// The median distance from a fix, as a multiple of what the sensor's noise explains; at least
  /// one. Likewise from a heading.
  double position_misfit = 1.0;
  double heading_misfit = 1.0;
  double residual_variance = 0.0;   ///< of residuals divided by noise and misfit
  double degrees_of_freedom = 0.0;  ///< residuals less all unknowns
  std::size_t shooting_segments = 0;
  std::size_t residuals = 0;
  std::size_t beyond_huber_threshold = 0;  ///< fixes and headings too far off to count in full
  bool converged = false;
};

/// Output error by multiple shooting, docs/concepts/model.md (50)..(53):
///   theta = argmin sum over shooting segments of min over x_0 of sum rho(|z - z(x_0, theta)| / s)
/// on raw antenna fixes and headings. Each shooting segment lasts some seconds and is simulated
/// from a free initial state. rho is Huber's loss. s is the sensor's noise or, where that is
/// larger, the scale of the residuals by their median. No continuity is imposed between segments. A
/// soft constraint would need the size of the process disturbance, which is unknown. A hard one
/// would attribute the disturbance to theta. Where there is no disturbance, longer segments add as
/// much information as continuity would.
///
/// Assumes: residuals are independent between clusters. The estimate is best where sensors, not
/// disturbances, separate model and measurement. A disturbance correlates with the boat's motion
/// and biases theta; no covariance shows that, but the misfits and Misspecification() do.
///
/// `start`: the initial model, from weak-form IV (StartOf) or any model of the parameterization. A
/// model without forces also serves, at the price of some iterations.
/// `columns`: sought by equation as in EstimateWeakIv. The data need not separate all of them; see
/// separability. Along inseparable directions the ridge prior keeps theta near `start`.
/// Refuses when: no shooting segment has enough measurements, residuals are no more than unknowns,
/// or every model found diverges.
/// Requires: at least one column; a dataset from Prepare.
Result<OutputErrorFit> EstimateOutputError(const PreparedDataset& dataset,
                                           const RegressionOptions& regression,
                                           const std::array<std::vector<std::size_t>, 3>& columns,
                                           const VesselModel& start,
                                           const OutputErrorOptions& options);

/// The regularised estimate of weak-form IV, or a model without forces where that has none.
/// Requires: data prepared with the robust preset.
VesselModel StartOf(const PreparedDataset& dataset, const RegressionOptions& regression,
                    const std::array<std::vector<std::size_t>, 3>& columns);

/// Whether the time constant stands at the lower limit of the search: the data show no lag.
bool LagIsAtLowerBound(const OutputErrorFit& fit);

}  // namespace telltale
