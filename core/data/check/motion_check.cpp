#include "telltale/core/data/check/motion_check.hpp"

#include <optional>
#include <utility>

#include "telltale/core/data/check/constant_angle.hpp"
#include "telltale/core/data/check/recorded_motion.hpp"
#include "telltale/core/data/check/stuck_channels.hpp"
#include "telltale/core/data/check/supposed_faults.hpp"

namespace telltale {

std::vector<Refusal> MotionFaults(const std::vector<GnssFix>& gnss,
                                  const std::vector<HeadingSample>& heading,
                                  const std::vector<ThrusterSample>& thrusters,
                                  const Vehicle& vehicle) {
  if (gnss.size() < 2 || heading.size() < 2 || thrusters.size() < 2) return {};
  const RecordedMotion motion(gnss, heading, thrusters, vehicle);
  std::vector<Refusal> faults;
  // A stuck channel makes its motion seem wrong, so it comes first.
  auto stuck = StuckChannel(gnss, heading, thrusters, motion);
  if (stuck) faults.push_back(*std::move(stuck));
  auto wrong = LikeliestSupposedFault(motion);
  if (!wrong) wrong = ConstantAngle(motion);
  if (wrong) faults.push_back(*std::move(wrong));
  return faults;
}

}  // namespace telltale
