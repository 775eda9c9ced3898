#pragma once

#include <vector>

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/samples.hpp"
#include "telltale/core/vessel/vehicle.hpp"

namespace telltale {

/// Faults of input that a recording's motion betrays: first a channel that keeps to one value while
/// the other channels say that it should not, then the fault that explains the motion far better
/// than input without fault: headings mirrored, counted from east, turned round, in radians or off
/// by a constant angle, latitude and longitude exchanged, thrusters swapped, one or both reversed.
///
/// Method: a boat's yaw rate grows with port less starboard command, r = b (p - s), and its
/// velocity lies along its heading and grows with their sum, u = a (p + s), v = 0, with a, b > 0
/// and commands behind a first-order lag (1 s and 3 s). Each supposed fault is undone and the two
/// lines fitted again; its gain in log-likelihood over the recording as it is, n/2 log(RSS / RSS'),
/// counts one sample each two lags. A fault is named where it gains more than 8 and explains at
/// least a tenth of the yaw rate's and three tenths of the velocity's square. A constant angle is
/// named where course less heading, freed of what goes with the yaw rate, keeps beyond 15 degrees
/// and four standard errors from zero over headings all around: the lines above leave it out. Where
/// a constant angle gains more than a fault by 8, that fault is not named: current and compass look
/// alike in a boat that keeps to one direction.
/// Shapes and units: as GnssFix, HeadingSample and ThrusterSample have them. Requires: times
/// ascend. Refuses when: never; a recording too short or too still shows no fault.
std::vector<Refusal> MotionFaults(const std::vector<GnssFix>& gnss,
                                  const std::vector<HeadingSample>& heading,
                                  const std::vector<ThrusterSample>& thrusters,
                                  const Vehicle& vehicle);

}  // namespace telltale
