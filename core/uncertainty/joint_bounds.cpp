#include "telltale/core/uncertainty/joint_bounds.hpp"

#include <algorithm>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/uncertainty/distributions.hpp"

namespace telltale {

double JointQuantile(double degrees_of_freedom, double unknowns, double level) {
  constexpr double kFewestSpare = 5.0;
  const double spare = std::max(degrees_of_freedom - unknowns + 1.0, kFewestSpare);
  return FisherQuantile(unknowns, spare, level);
}

double SquaredRadius(const JointBounds& joint, std::size_t unknowns, double level) {
  Require(unknowns > 0, "at least one unknown");
  const auto q = static_cast<double>(unknowns);
  return joint.covariance_factor * q * JointQuantile(joint.degrees_of_freedom, q, level);
}

}  // namespace telltale
