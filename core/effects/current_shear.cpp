#include <cmath>

#include "telltale/core/effects/effect_instance.hpp"
#include "telltale/core/effects/wording.hpp"

namespace telltale {
namespace {

constexpr double kTypicalShear =
    0.004;  // 1/s: 0.2 m/s over 50 m, as off a bank or in the lee of a pier
constexpr double kLargestShear = 0.05;
constexpr double kStatedOverM = 50.0;

}  // namespace

class CurrentShearEffect final : public Effect {
 public:
  CurrentShearEffect()
      : Effect(
            {.name = "current_shear",
             .title = "a current that changes with place",
             .equation = "V_c = G (p - p_m), G = [s, g_n; g_e, -s], p_m the middle of the track; "
                         "nu_r = nu - R(psi)' V_c in the hull's forces, and nu_dot += "
                         "(r v_c, -r u_c, 0) + R(psi)' G p_dot",
             .source = "Fossen 2021, chapter 10, for the current; first order of a field without "
                       "divergence, Batchelor, An Introduction to Fluid Dynamics, 1967, 2.3",
             .parameters = {{"north_by_east", "1/s", kTypicalShear, -kLargestShear, kLargestShear},
                            {"east_by_north", "1/s", kTypicalShear, -kLargestShear, kLargestShear},
                            {"north_by_north", "1/s", kTypicalShear, -kLargestShear,
                             kLargestShear}},
             .settled_by = "a log of speed through the water",
             .nominal_variation = NominalVariation::kRecordingEffect}) {}

  std::string Describe(EffectValues values) const override {
    // The larger singular value of the gradient.
    const double turning = 0.5 * std::abs(values[1] - values[0]);
    const double straining = std::hypot(0.5 * (values[0] + values[1]), values[2]);
    return "a current that changes by up to " +
           FormatNumber(kStatedOverM * (turning + straining), 2) + " m/s over " +
           FormatNumber(kStatedOverM, 0) + " m";
  }

  Eigen::Matrix2d CurrentGradient(EffectValues values) const override {
    Eigen::Matrix2d gradient;
    gradient << values[2], values[0], values[1], -values[2];
    return gradient;
  }
};

template const Effect& InstanceOf<CurrentShearEffect>();

}  // namespace telltale
