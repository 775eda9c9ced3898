#pragma once

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/regression/parameter_block.hpp"
#include "telltale/core/estimation/weak_form/weak_form.hpp"
#include "telltale/core/vessel/disturbance.hpp"
#include "telltale/core/vessel/thruster_response.hpp"
#include "telltale/core/vessel/vessel_model.hpp"

namespace telltale {

struct WeakIvOptions {
  WeakFormOptions form;
  double ridge = 0.02;  ///< of what simulates the instruments, relative to unit columns
  int iterations = 4;   ///< simulations of the instruments, each with the newest theta
};

/// One equation's share of a weak-form fit, over the windows of WeakProblem::windows.
/// Shapes: theta p; G and Z windows x p; residual, one per window. With V the covariance of
/// residuals, theta = (Z'G)^-1 Z'b.
struct WeakEstimate {
  std::vector<std::size_t> columns;  ///< of Regressors() and RecordingBiasTerms, those sought
  Eigen::VectorXd theta;
  Eigen::VectorXd regularised;  ///< theta shrunk along directions that the data hardly move
  Eigen::MatrixXd G;            ///< regressors, weighed, with what filtering has lost of them
  Eigen::MatrixXd Z;            ///< their instruments, V^-1 times what they are weighed to
  Eigen::VectorXd residual;
};

/// Shapes, with P the stacked unknowns (the time constant first if it is sought, then the
/// coefficients of each answered equation): bread P x P = (Z'G)^-1, scores P x clusters, which add
/// up to Z'e, each by what is new in its windows. theta - truth = bread Z'e, so
/// Cov(theta) = bread Cov(sum of scores) bread'.
struct WeakFit {
  WeakProblem problem;
  std::array<std::optional<WeakEstimate>, 3> equations;
  std::optional<double> time_constant_s;
  Eigen::VectorXd theta;
  Eigen::MatrixXd bread;
  Eigen::MatrixXd scores;
  /// P x P, Cov(theta) if what is new in the residuals of each equation were alike all along.
  Eigen::MatrixXd stationary_covariance;

  /// Where the coefficients of an answered equation stand among the stacked unknowns.
  Block BlockOf(std::size_t equation) const;
  /// All there are: of the time constant first, if it is sought.
  std::vector<Block> Blocks() const;
  /// The stacked unknowns with the damped coefficients in place of theta.
  Eigen::VectorXd Regularised() const;
};

/// Weak-form instrumental variables, docs/concepts/model.md (31):
///   theta = (Z'V^-1 G)^-1 Z'V^-1 b
/// with V what the residuals' correlations are believed to be (ResidualWhitening) and Z weighed
/// like G but from velocities simulated with the model itself (Instruments), which share the
/// commands with the boat but no noise of its sensors: least squares started from, then repeated
/// with the newest theta. What noise adds to G and what filtering before multiplying loses of it
/// are made good to first order.
/// Nothing when the instruments blow up or determine nothing.
/// Requires: data prepared with the robust preset; columns sought per equation, empty to leave the
/// equation out: places in Regressors() or, beyond those, in the RecordingBiasTerms that
/// regression.offsets asks for, which stand in for the regressor "1".
std::optional<WeakFit> EstimateWeakIv(const PreparedDataset& dataset,
                                      const RegressionOptions& regression,
                                      const std::array<std::vector<std::size_t>, 3>& columns,
                                      const WeakIvOptions& options);

/// Every regressor of every equation: what to seek when the data move all of them.
std::array<std::vector<std::size_t>, 3> AllColumns(Parameterization parameterization);

/// RecordingBiasTerms in place of the regressor "1", each in every equation that has a window in
/// its recording; those that turn with psi only where `heading_varies`. `columns` as they are
/// without.
std::array<std::vector<std::size_t>, 3> WithRecordingBiasTerms(
    const PreparedDataset& dataset, const WeakProblem& problem,
    const std::array<std::vector<std::size_t>, 3>& columns,
    const std::vector<bool>& heading_varies);

/// The steady disturbance by recording that stacked unknowns of such a fit describe; none where the
/// regressor "1" is shared.
std::vector<ConstantDisturbance> ConstantDisturbancesOf(const WeakFit& fit,
                                                        const Eigen::VectorXd& theta);

/// Boats that may well have given the data.
struct RidgePosterior {
  Eigen::VectorXd posterior_mean;  ///< stacked unknowns
  Eigen::MatrixXd covariance;      ///< about the middle
};

/// Boats that may well have given the data, docs/concepts/model.md (34): as normal prior forces of
/// one size see the estimate, that size chosen such that the middle lies where
///   (theta - middle)' Cov^-1 (theta - middle) = reach P
/// while the truth is expected at a reach of one. The estimate itself is wild where regressors are
/// nearly alike, the truth hardly ever is.
RidgePosterior RidgePosteriorOf(const WeakFit& fit, double prior_scale);

/// The model that stacked unknowns of such a fit describe; coefficients not sought are zero, so
/// where each recording has a steady disturbance of its own there is none in the model.
VesselModel ModelOf(const WeakFit& fit, const Eigen::VectorXd& theta, double sampling_period_s);

/// Whether the time constant stands at the least that is sought: no lag is seen.
bool LagIsAtLowerBound(const WeakFit& fit);

/// Cov(theta) from the scores of the clusters, drawn towards the shape that residuals correlated
/// alike all along would give it by p / (p + g): g clusters alone leave it singular or nearly so
/// when p is not far below g.
Eigen::MatrixXd ClusterCovariance(const WeakFit& fit);

}  // namespace telltale
