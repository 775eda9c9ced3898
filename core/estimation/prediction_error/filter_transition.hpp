#pragma once

#include <Eigen/Core>

namespace telltale {

/// States of the filter: position north, east and heading of the body origin; u, v, r through the
/// water; the disturbing accelerations; the drift of the fixes north and east; the current north
/// and east; what the compass reads too much.
inline constexpr int kFilterStates = 14;
inline constexpr int kNorthState = 0;
inline constexpr int kHeadingState = 2;
inline constexpr int kVelocityState = 3;
inline constexpr int kDisturbanceState = 6;
inline constexpr int kDriftState = 9;
inline constexpr int kCurrentState = 11;
inline constexpr int kMisalignmentState = 13;
using FilterState = Eigen::Matrix<double, kFilterStates, 1>;
using FilterCovariance = Eigen::Matrix<double, kFilterStates, kFilterStates>;

/// Position, heading and velocities move; the other states decay or stay. Of all states, those from
/// the heading to the disturbance move them, and the current the position.
inline constexpr int kMovingStates = kDisturbanceState;
inline constexpr int kDecayingStates = kFilterStates - kMovingStates;
inline constexpr int kMovers = kDriftState - kHeadingState;
using DecayOfStates = Eigen::Matrix<double, kDecayingStates, 1>;
using MotionByMovers = Eigen::Matrix<double, kMovingStates, kMovers>;

/// The transition matrix of one step by its blocks that are not zero: products with it take a fifth
/// of the time of those with the whole.
struct FilterTransition {
  double step_s = 0.0;
  /// Without the identity of the position. The last three columns are those of the disturbance, an
  /// acceleration that is held over the step.
  MotionByMovers by_movers;
  DecayOfStates decay;

  /// The rows that move of the transition times `m`.
  template <int kColumns>
  Eigen::Matrix<double, kMovingStates, kColumns> Moved(
      const Eigen::Matrix<double, kFilterStates, kColumns>& m) const {
    Eigen::Matrix<double, kMovingStates, kColumns> moved =
        by_movers.lazyProduct(m.template middleRows<kMovers>(kHeadingState));
    moved.template topRows<2>() +=
        m.template topRows<2>() + step_s * m.template middleRows<2>(kCurrentState);
    return moved;
  }

  FilterCovariance Whole() const {
    FilterCovariance whole = FilterCovariance::Zero();
    whole.topRows<kMovingStates>() = Moved<kFilterStates>(FilterCovariance::Identity());
    whole.bottomRightCorner<kDecayingStates, kDecayingStates>() = decay.asDiagonal();
    return whole;
  }
};

}  // namespace telltale
