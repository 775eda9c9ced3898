#include "telltale/core/vessel/thruster_response.hpp"

#include <cmath>

#include "telltale/core/base/contract.hpp"

namespace telltale {

LagPerPeriod LagOver(double periods) {
  Require(periods >= 0.0, "a lag that is not negative");
  if (periods == 0.0) return {};
  LagPerPeriod lag;
  lag.remaining = std::exp(-1.0 / periods);
  // 1 - exp(-x) keeps its digits for long lags too.
  lag.mean = periods * -std::expm1(-1.0 / periods);
  lag.remaining_slope = lag.remaining / (periods * periods);
  lag.mean_slope = -std::expm1(-1.0 / periods) - lag.remaining / periods;
  return lag;
}

}  // namespace telltale
