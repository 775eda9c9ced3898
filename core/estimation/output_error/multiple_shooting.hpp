#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/data/north_east_frame.hpp"
#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/regression/regression_problem.hpp"
#include "telltale/core/vessel/vessel_model.hpp"

namespace telltale {

/// x, y, psi, u, v, r of the body origin; x and y from where the shot was guessed to begin.
using ShootingState = Eigen::Matrix<double, 6, 1>;

/// The unknowns that all shots share, stacked: the thruster time constant if it is sought, then the
/// sought coefficients of surge, sway and yaw.
struct SharedUnknowns {
  Parameterization parameterization = Parameterization::kUnknown;
  DeadZone dead_zone;
  bool lagging = false;
  std::array<std::vector<std::size_t>, 3> columns;  ///< of Regressors(), ascending, by equation

  Eigen::Index Size() const;
  Eigen::Index First(Equation equation) const;  ///< place of an equation's first coefficient

  /// The model that they describe; coefficients not sought are zero.
  VesselModel ModelWith(const Eigen::VectorXd& theta, double sampling_period_s) const;

  /// Their values in a model of the same parameterization.
  Eigen::VectorXd In(const VesselModel& model) const;
};

struct ShootingOptions {
  double length_s = 8.0;             ///< of a shot, about; [2, 60]
  double longest_cluster_s = 20.0;   ///< shots within this length count as one cluster,
  double shortest_cluster_s = 8.0;   ///< less, down to this,
  std::size_t wanted_clusters = 80;  ///< where that gives fewer clusters than these
  /// However still a sensor's record, it is believed no better than this.
  double least_position_noise_m = 0.005;
  double least_heading_noise_rad = 0.001;
};

/// Headings met between two nodes, as one: their mean is a weighted sum of heading and yaw rate at
/// both nodes, by the cubic through them, exact to fourth order however the samples lie.
struct MeanHeading {
  double psi_rad = 0.0;
  double noise_rad = 0.0;
  double psi_before = 0.0, r_before = 0.0, psi_after = 0.0, r_after = 0.0;  ///< weights
};

/// An instant at which the integration stops: a fix, a change of command, an end of the shot.
struct ShootingNode {
  double leg_s = 0.0;                    ///< until the next node; zero at the last
  ThrustRegressors steady;               ///< what the command along the leg leads to
  std::optional<NorthEastPosition> fix;  ///< from where the shot was guessed to begin
  std::optional<MeanHeading> heading;    ///< along the leg
};

/// A piece of a recording that the model sails from a free initial state.
struct ShootingSegment {
  struct Held {
    ThrustRegressors steady;
    double duration_s = 0.0;
  };
  std::vector<Held> before;  ///< commands that thrusters may still remember, the oldest first
  std::vector<ShootingNode> nodes;
  ShootingState guess;  ///< by the prepared row at which it begins
  std::size_t cluster = 0;
  std::size_t fixes = 0;
  std::size_t headings = 0;

  Eigen::Index Residuals() const { return static_cast<Eigen::Index>(2 * fixes + headings); }
};

/// A dataset cut into shots, in order of time; clusters are numbered from zero without gaps.
struct ShootingPlan {
  std::vector<ShootingSegment> shooting_segments;
  std::size_t clusters = 0;
  double position_noise_m = 0.0;
  LeverArm antenna;
};

/// Shots stay inside a segment and inside rows that enter every equation sought. Pieces too short
/// or too poorly measured to fix a state are left out. Antenna fixes and headings are taken as they
/// came, headings averaged between nodes.
ShootingPlan CutShootingSegments(const PreparedDataset& dataset,
                                 const RegressionOptions& regression,
                                 const SharedUnknowns& unknowns, const ShootingOptions& options);

/// By what residuals are judged. One size of each sensor's residuals is its noise times `position`
/// or `heading`: more than one where something else than the sensor keeps model and measurement
/// apart. Beyond `knee` sizes a residual counts in proportion and no longer by its square (Huber);
/// a fix is judged by its distance.
struct NoiseScale {
  double position = 1.0;
  double heading = 1.0;
  double huber_threshold = std::numeric_limits<double>::infinity();
};

using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// What a shot misses by: model less measurement by the yardstick, past the knee such that the
/// square is Huber's loss. In the order of the nodes: north and east of a fix, then the mean
/// heading.
struct ShootingResidual {
  Eigen::VectorXd residual;
  RowMajorMatrix by_start;   ///< n x 6
  RowMajorMatrix by_shared;  ///< n x P
};

/// Sails a shot, docs/concepts/model.md (50), (51): Runge-Kutta of order four from node to node,
/// the derivatives by the variational equations along the same steps, so that they are those of the
/// residuals exactly. A lagging thrust enters each step with its exact mean.
/// Nothing when the model runs away. Requires: theta as long as the shared unknowns.
std::optional<ShootingResidual> ComputeShootingResidual(
    const ShootingPlan& plan, const ShootingSegment& shooting_segment,
    const SharedUnknowns& unknowns, const Eigen::VectorXd& theta, const ShootingState& start,
    const NoiseScale& noise_scale, bool with_derivatives);

}  // namespace telltale
