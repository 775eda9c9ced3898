#pragma once

#include <Eigen/Core>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/effects/augmented_boat.hpp"

namespace telltale {

/// A vector of the body frame, north and east.
Eigen::Vector2d Turned(double psi_rad, double forward, double starboard);

/// The boat as measured, between the rows of a segment and held at its ends. Requires: two rows.
Pose MeasuredAt(const PreparedDataset& dataset, const RowRange& segment, double time_s);

/// The boat behind what sensors with the faults of `boat` say: of a turned compass, an antenna
/// elsewhere, old positions.
Pose TrueStart(const PreparedDataset& dataset, const RowRange& segment, double time_s,
               const AugmentedBoat& boat);

/// What such sensors make of a boat: the inverse of TrueStart. `past` is where the boat was when
/// the position now stamped was taken.
Pose MeasuredPose(const Pose& now, const Pose& past, const LeverArm& stated,
                  const AugmentedBoat& boat);

}  // namespace telltale
