#include "vessel/thruster_lag.hpp"

#include <cmath>

namespace telltale {

double MeanLagShare(double alpha) {
  if (alpha <= 0.0) return 0.0;
  if (alpha >= 1.0) return 1.0;
  return (1.0 - alpha) / -std::log(alpha);
}

double MeanLagShareSlope(double alpha) {
  const double periods = -std::log(alpha);  // of the time constant in one sampling period
  return ((1.0 - alpha) / alpha - periods) / (periods * periods);
}

}  // namespace telltale
