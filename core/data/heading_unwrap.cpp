#include "telltale/core/data/heading_unwrap.hpp"

#include "telltale/core/base/degrees.hpp"
#include "telltale/core/vessel/motion.hpp"

namespace telltale {

std::vector<double> Unwrap(std::span<const HeadingSample> samples) {
  std::vector<double> psi;
  psi.reserve(samples.size());
  for (const HeadingSample& sample : samples) {
    const double heading = sample.heading_deg * kRadiansPerDegree;
    psi.push_back(psi.empty() ? heading : psi.back() + WrapAngle(heading - psi.back()));
  }
  return psi;
}

}  // namespace telltale
