#pragma once

#include "telltale/core/effects/effect.hpp"

namespace telltale {

/// A load in a boat and what it does to the water that the hull carries along.
struct Load {
  double mass_gain = 0.0;        ///< p, over the boat's dry mass
  double forward_m = 0.0;        ///< x, of the body origin
  double added_mass_gain = 0.0;  ///< a, of A22 and A66, as a share of each
};

/// The boat's accelerations with a load, less those without it, `light`.
/// Model: (1 + p) u_dot, (1 + q_v) v_dot + p_v x r_dot and (1 + q_r) r_dot + p_r v_dot are the
/// boat's own + p (v r + x r^2) + a A22 / m v_r r, - p_v u r, - p_r u r - a A22 / (I + A66) u_r
/// v_r, with p_v = p m / (m + A22), q_v = p_v + a A22 / (m + A22), p_r = p x m / (I + A66) and q_r
/// = p_r x + a A66 / (I + A66); A11 is neglected beside m. Assumes: the hull scale of `instant`.
/// Source: Fossen 2021, chapter 3 for the point mass, chapter 6 for the added mass.
NuDot LoadedLess(const NuDot& light, const Load& load, const InstantState& instant);

}  // namespace telltale
