#include "telltale/core/vessel/fossen_matrices.hpp"

namespace telltale {

FossenMatrices MatricesOf(const FossenVector& parameters) {
  using enum FossenParameter;
  const auto p = [&](FossenParameter parameter) { return parameters[At(parameter)]; };
  FossenMatrices matrices;
  matrices.mass << 1.0, 0.0, 0.0, 0.0, p(kM22), p(kM23), 0.0, p(kM23), p(kM33);
  matrices.linear_damping << p(kXu), 0.0, 0.0, 0.0, p(kYv), p(kYr), 0.0, p(kNv), p(kNr);
  matrices.lift_damping << 0.0, 0.0, 0.0, 0.0, p(kYuv), p(kYur), 0.0, p(kNuv), p(kNur);
  matrices.quadratic_damping << p(kXuu), 0.0, 0.0, 0.0, p(kYvv), 0.0, 0.0, p(kNvv), p(kNrr);
  matrices.cross_flow_damping << 0.0, 0.0, 0.0, 0.0, 0.0, p(kYrv), 0.0, p(kNvr), 0.0;
  return matrices;
}

}  // namespace telltale
