#include "telltale/core/drift/known_thrust.hpp"

#include <cmath>

#include "telltale/core/identification/input_gain.hpp"

namespace telltale {

bool KnowsThrust(const Identification& identification) {
  constexpr Eigen::Index kSurge = 0;
  constexpr Eigen::Index kYaw = 2;
  for (const PropellerCommand& delta : {PropellerCommand{1.0, 0.0}, PropellerCommand{0.0, 1.0}}) {
    const InputGain gain = SteadyInputGain(identification, delta);
    const Eigen::Vector3d standard_errors = gain.StandardErrors();
    for (const Eigen::Index axis : {kSurge, kYaw}) {
      if (!(std::abs(gain.gain[axis]) > standard_errors[axis])) return false;
    }
  }
  return true;
}

}  // namespace telltale
