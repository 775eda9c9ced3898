#include "effects/effect.hpp"
#include "effects/library.hpp"
#include "effects/wording.hpp"

namespace telltale {
namespace {

class ThrusterLagEffect final : public Effect {
 public:
  ThrusterLagEffect()
      : Effect({.name = "thruster_lag",
                .title = "thrusters that lag",
                .equation = "tau dT/dt = T_c - T",
                .source = "The paper, first-order dynamic propellers",
                .parameters = {{"time_constant", "s", 0.2, 0.0, 2.0}},
                .settled_by = "the speed of the propellers"}) {}

  std::string Describe(EffectValues values) const override {
    return "thrust follows commands " + Number(values[0], 2) + " s more slowly";
  }

  double LagS(EffectValues values) const override { return values[0]; }
};

}  // namespace

const Effect& ThrusterLag() {
  static const ThrusterLagEffect effect;
  return effect;
}

}  // namespace telltale
