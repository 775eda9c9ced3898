#include "telltale/core/vessel/body_regressors.hpp"

#include <numbers>

namespace telltale {
namespace {

/// The bias that normal noise of standard deviation sigma gives |x| and x |x|.
struct NoiseBias {
  double to_size = 0.0;
  double to_square = 0.0;
};

NoiseBias BiasOf(double x, double sigma) {
  if (sigma <= 0.0) return {};
  const double z = x / sigma;
  const double inside = std::erf(z / std::numbers::sqrt2);
  const double density = std::exp(-0.5 * z * z) * std::numbers::inv_sqrtpi / std::numbers::sqrt2;
  return {x * inside + 2.0 * sigma * density - std::abs(x),
          (x * x + sigma * sigma) * inside + 2.0 * x * sigma * density - x * std::abs(x)};
}

}  // namespace

BodyRow NoiseCorrectedBodyRow(const Nu& nu, const Nu& noise) {
  const NoiseBias u = BiasOf(nu.u, noise.u);
  const NoiseBias v = BiasOf(nu.v, noise.v);
  const NoiseBias r = BiasOf(nu.r, noise.r);
  BodyRow row = BodyRowAt(nu);
  row.surge[0] -= u.to_square;
  row.surge[2] -= noise.r * noise.r;
  row.turning[0] -= v.to_square;
  row.turning[1] -= nu.v * r.to_size;
  row.turning[2] -= nu.r * v.to_size;
  row.turning[3] -= r.to_square;
  return row;
}

}  // namespace telltale
