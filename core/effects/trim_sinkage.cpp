#include <algorithm>
#include <cmath>

#include "telltale/core/effects/effect_instance.hpp"
#include "telltale/core/effects/load.hpp"
#include "telltale/core/effects/wording.hpp"

namespace telltale {
namespace {

// Of slender hulls with a block coefficient of 0.6, a waterplane coefficient of 0.8 and a
// coefficient of the waterplane's longitudinal inertia of 0.64.
constexpr double kSinkagePerGain = 0.75;  // of the draught, C_B / C_WP
constexpr double kTrimPerArm = 5.6;       // of the draught at the bow, 6 C_B / C_IL

/// Wetted surface over that of the unladen hulls, by Denny and Mumford: S = 1.7 L T + volume / T of
/// each of two hulls. Sides over bottoms of the default hull are 1.7 L T / (volume / T) = 1.82.
double WettedSurfaceRatio(double gain, double sinkage, const HullScale& hull) {
  const double sides = 1.82 * hull.length * hull.draught * hull.draught / hull.mass;
  return (sides * (1.0 + sinkage) + (1.0 + gain) / (1.0 + sinkage)) / (sides + 1.0);
}

}  // namespace

class TrimSinkageEffect final : public Effect {
 public:
  TrimSinkageEffect()
      : Effect(
            {.name = "trim_sinkage",
             .title = "a load that trims and sinks the hull",
             .equation = "a load p m at x forward, as payload, with sinkage s = 0.75 p and trim "
                         "t = 5.6 p x / L of the draught at the bow; X_|u|u and X_u grow with the "
                         "wetted surface, the damping of sway and yaw with (1 + s)^q, A22 and A66 "
                         "by c ((1 + s)^2 - 1); r_dot += t L / 6 (m + A22) / (I + A66) "
                         "(Y_|v|v |v| v + Y_v v)",
             .source = "docs/concepts/diagnosis.md (117): Fossen 2021, chapters 3, 4 and 6: point "
                       "mass, hydrostatics, strip theory; Brix, Manoeuvring Technical Manual, "
                       "1993: draught and trim; Denny and Mumford, in Molland, Turnock and Hudson "
                       "2017, chapter 10: wetted surface; Faltinsen 1990, chapter 6, and Newman, "
                       "Marine Hydrodynamics, 1977, chapter 7: cross-flow drag and lift",
             .parameters = {{"mass_gain", "1", 0.2, -0.6, 2.0},
                            {"forward_m", "m", 0.2, -0.6, 0.6, true, 0.0},
                            {"damping_power", "1", 1.0, 0.0, 2.0, true, 1.0},
                            {"added_mass_ratio", "1", 0.5, 0.0, 3.0, true, 1.0}},
             .settled_by = "a scale, or the draught at bow and stern",
             .hook = Hook::kAcceleration,
             .nominal_variation = NominalVariation::kInCoefficients}) {}

  std::string Describe(EffectValues values) const override {
    return Percent(values[0]) +
           (values[0] < 0.0 ? " less mass, floating " : " more mass, floating ") +
           Percent(kSinkagePerGain * values[0]) + (values[0] < 0.0 ? " higher" : " deeper");
  }

  NuDot AddedAcceleration(EffectValues values, const InstantState& instant) const override {
    const double gain = values[0];
    const double forward_m = values[1];
    const HullScale& hull = instant.hull_scale;
    const double sinkage = kSinkagePerGain * gain;
    const double damping = std::pow(1.0 + sinkage, values[2]) - 1.0;
    const double added_mass = values[3] * ((1.0 + sinkage) * (1.0 + sinkage) - 1.0);
    const double trim = std::clamp(kTrimPerArm * gain * forward_m / hull.length_m, -1.0, 1.0);
    const double inertia = hull.yaw_inertia * hull.gyration_radius_m * hull.gyration_radius_m;
    const double lever = trim * hull.length_m / 6.0 * hull.sway_mass / inertia;
    const auto& [surge, sway, yaw] = instant.hull;
    const NuDot deeper = {(WettedSurfaceRatio(gain, sinkage, hull) - 1.0) * (surge[0] + surge[3]),
                          damping * Damping(sway),
                          damping * Damping(yaw) + lever * (sway[0] + sway[6])};
    const NuDot own = instant.Acceleration();
    const NuDot loaded = LoadedLess({own.u + deeper.u, own.v + deeper.v, own.r + deeper.r},
                                    {gain, forward_m, added_mass}, instant);
    return {deeper.u + loaded.u, deeper.v + loaded.v, deeper.r + loaded.r};
  }

 private:
  /// Of sway or yaw: the terms in v|v|, v|r|, r|v|, r|r|, v and r.
  static double Damping(const std::array<double, 9>& hull) {
    return hull[0] + hull[1] + hull[2] + hull[3] + hull[6] + hull[7];
  }
};

template const Effect& InstanceOf<TrimSinkageEffect>();

}  // namespace telltale
