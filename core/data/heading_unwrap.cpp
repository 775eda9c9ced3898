#include "telltale/core/data/heading_unwrap.hpp"

#include "telltale/core/base/degrees.hpp"
#include "telltale/core/vessel/motion.hpp"

namespace telltale {

double UnwrappedBehind(const std::vector<double>& psi_rad, double heading_deg) {
  const double heading = heading_deg * kRadiansPerDegree;
  return psi_rad.empty() ? heading : psi_rad.back() + WrapAngle(heading - psi_rad.back());
}

std::vector<double> Unwrap(std::span<const HeadingSample> samples) {
  std::vector<double> psi;
  psi.reserve(samples.size());
  for (const HeadingSample& sample : samples) {
    psi.push_back(UnwrappedBehind(psi, sample.heading_deg));
  }
  return psi;
}

}  // namespace telltale
