#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/output_error/multiple_shooting.hpp"
#include "telltale/core/estimation/output_error/separability.hpp"
#include "telltale/core/estimation/regression/regression_problem.hpp"
#include "telltale/core/vessel/vessel_model.hpp"

namespace telltale {

struct OutputErrorOptions {
  ShootingOptions shooting_segments;
  double huber_threshold =
      3.0;  ///< Huber's, in standard deviations of the residuals as they are; [1, 100]
  double inseparable_condition_index = 1000.0;  ///< [10, 1e6]
  int iterations = 100;                         ///< at most, once roughly there

  /// The first field out of its range, as a refusal naming field, value and range.
  std::optional<Refusal> Validate() const;
};

/// Shapes, with P the shared unknowns as SharedUnknowns stacks them and g clusters: theta P;
/// information P x P, the Schur complement H of the shots' states; scores P x g, q_s = -J'r over
/// the shots of cluster s after that elimination. theta - truth = H^-1 sum_s q_s to first order.
struct OutputErrorFit {
  SharedUnknowns unknowns;
  Eigen::VectorXd theta;
  Eigen::VectorXd begin;              ///< where theta began, towards which a weak pull keeps it
  std::vector<ShootingState> starts;  ///< in which the shots start
  Eigen::MatrixXd information;
  Eigen::MatrixXd scores;
  std::vector<Eigen::MatrixXd> cluster_information;  ///< sum: information
  Separability separability;
  double position_misfit =
      1.0;  ///< typical distance from a fix in the sensor's noise; one where the
  double heading_misfit = 1.0;      ///< sensor alone is to blame; likewise from headings
  double residual_variance = 0.0;   ///< of residuals in sizes of such
  double degrees_of_freedom = 0.0;  ///< residuals less all unknowns
  std::size_t shooting_segments = 0;
  std::size_t residuals = 0;
  std::size_t beyond_huber_threshold = 0;  ///< fixes and headings too far off to count in full
  bool converged = false;
};

/// Output error by multiple shooting, docs/concepts/model.md (50)..(53):
///   theta = argmin sum over shots of min over x_0 of sum rho(|z - z(x_0, theta)| / size)
/// straight on antenna fixes and headings as they came, each shot of some seconds sailed from a
/// free initial state, rho Huber's, size the sensor's noise or, where that is larger, the median
/// size of its residuals. Shots are not tied to each other: were they, the difference between the
/// end of one and the start of the next would have to be weighed by a process disturbance that
/// nobody knows, and as a hard constraint it would book that disturbance to theta. What ties would
/// add where there is no disturbance, longer shots add as well.
///
/// Assumes: residuals independent from cluster to cluster. Best where sensors, not disturbances,
/// are what keeps model and measurement apart: a disturbance that the boat's motion carries along
/// correlates with what the model is asked to explain, biases theta, and no covariance shows that;
/// the misfits and Misspecification() do.
///
/// `start`: where to begin, from weak-form IV (StartOf) or any model of the parameterization; a
/// boat that nothing pushes does as well, at the price of some iterations.
/// Columns sought per equation as in EstimateWeakIv. Data need not tell everything apart: see
/// separability; theta then stays near `start` along what is not told, where a weak pull keeps it.
/// Refuses when: no shot is measured well enough, residuals are no more than unknowns, or every
/// model met runs away.
/// Requires: at least one column; a dataset from Prepare.
Result<OutputErrorFit> EstimateOutputError(const PreparedDataset& dataset,
                                           const RegressionOptions& regression,
                                           const std::array<std::vector<std::size_t>, 3>& columns,
                                           const VesselModel& start,
                                           const OutputErrorOptions& options);

/// The damped estimate of weak-form IV, or a boat that nothing pushes where that has no answer.
/// Requires: data prepared with the robust preset.
VesselModel StartOf(const PreparedDataset& dataset, const RegressionOptions& regression,
                    const std::array<std::vector<std::size_t>, 3>& columns);

/// The cluster sandwich H^-1 (sum_s q_s q_s') H^-1, each cluster's residuals taken as they would be
/// had theta been fitted without it (leave-one-out, to first order: q_s meets (H - H_s)^-1).
/// Without that, P unknowns fitted to g clusters leave residuals too small to vouch for themselves.
/// Bounds: Student's t with g - 1 degrees of freedom.
Eigen::MatrixXd ClusterCovariance(const OutputErrorFit& fit);

/// s^2 H^-1: what white residuals would mean for theta.
Eigen::MatrixXd NaiveCovariance(const OutputErrorFit& fit);

/// How far standard errors by cluster exceed naive ones, docs/concepts/model.md (54): the geometric
/// mean over the separable coefficients of an equation, in the equation where it is most; zero if
/// there are none. Near one where the model leaves nothing but white noise; well above it, an alarm
/// that something else, a disturbance or a missing term, is at work.
double Misspecification(const OutputErrorFit& fit);

/// Whether the time constant stands at the least that is sought: no lag is seen.
bool LagIsAtLowerBound(const OutputErrorFit& fit);

/// "SURGE u|u|", "thruster time constant": the unknown at a place in theta.
std::string NameOf(const SharedUnknowns& unknowns, std::size_t unknown);

/// What an inseparable direction means for an operator.
Refusal Explain(const InseparableDirection& direction, const SharedUnknowns& unknowns);

}  // namespace telltale
