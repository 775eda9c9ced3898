#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/data/north_east_frame.hpp"
#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/output_error/shared_unknowns.hpp"
#include "telltale/core/estimation/regression/cluster_options.hpp"
#include "telltale/core/estimation/regression/regression_problem.hpp"

namespace telltale {

/// x, y, psi, u, v, r of the body origin. x and y are relative to the initial guess of the
/// segment's first position.
using ShootingState = Eigen::Matrix<double, 6, 1>;

struct ShootingOptions {
  double length_s = 8.0;    ///< of a shooting segment, approximately; [2, 60]
  ClusterOptions clusters;  ///< of shooting segments, by their centres
  /// Lower limits of the sensors' noise, whatever their records show.
  double least_position_noise_m = 0.005;
  double least_heading_noise_rad = 0.001;
};

/// The mean of the headings measured between two nodes. The model's counterpart is a weighted sum
/// of heading and yaw rate at both nodes, by the cubic through them. It is exact to fourth order
/// wherever the samples lie.
struct MeanHeading {
  double psi_rad = 0.0;
  double noise_rad = 0.0;
  double psi_before = 0.0, r_before = 0.0, psi_after = 0.0, r_after = 0.0;  ///< weights
};

/// An instant at which the integration stops: a fix, a change of command, an end of the segment, or
/// the longest step.
struct ShootingNode {
  double leg_s = 0.0;                    ///< until the next node; zero at the last
  ThrustRegressors steady;               ///< steady-state thrust of the command along the leg
  std::optional<NorthEastPosition> fix;  ///< relative to the guess of the first position
  std::optional<MeanHeading> heading;    ///< along the leg
};

/// A shooting segment: a part of a recording that the model simulates from a free initial state.
struct ShootingSegment {
  struct Held {
    ThrustRegressors steady;
    double duration_s = 0.0;
  };
  std::vector<Held> before;  ///< commands that still affect the thrust at the start, oldest first
  std::vector<ShootingNode> nodes;
  ShootingState guess;  ///< from the prepared row at which it begins
  std::size_t cluster = 0;
  std::size_t fixes = 0;
  std::size_t headings = 0;

  Eigen::Index Residuals() const { return static_cast<Eigen::Index>(2 * fixes + headings); }
};

/// A dataset cut into shooting segments, in order of time; clusters are numbered from zero without
/// gaps.
struct ShootingPlan {
  std::vector<ShootingSegment> shooting_segments;
  std::size_t clusters = 0;
  double position_noise_m = 0.0;
  LeverArm antenna;
};

/// Shooting segments stay inside a segment of the dataset and inside rows that enter every equation
/// sought. Those shorter than half the length asked for, with fewer than four fixes or fewer than
/// three headings are left out. Antenna fixes and headings are the raw measurements, headings
/// averaged between nodes.
/// Requires: the raw signals of every segment.
ShootingPlan CutShootingSegments(const PreparedDataset& dataset,
                                 const RegressionOptions& regression,
                                 const SharedUnknowns& unknowns, const ShootingOptions& options);

}  // namespace telltale
