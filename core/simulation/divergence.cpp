#include "telltale/core/simulation/divergence.hpp"

#include <algorithm>
#include <cmath>

namespace telltale {

bool Within(const Nu& nu, const Nu& limits) {
  return std::abs(nu.u) < limits.u && std::abs(nu.v) < limits.v && std::abs(nu.r) < limits.r;
}

Nu RelativeDivergence::LimitsFor(const Nu& fastest) const {
  return {std::max(times_fastest * fastest.u, at_least),
          std::max(times_fastest * fastest.v, at_least),
          std::max(times_fastest * fastest.r, at_least)};
}

bool AbsoluteDivergence::Exceeds(const Nu& nu) const {
  return !(std::hypot(nu.u, nu.v) < speed_mps && std::abs(nu.r) < yaw_rate_radps);
}

}  // namespace telltale
