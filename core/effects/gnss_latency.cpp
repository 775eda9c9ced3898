#include "telltale/core/effects/effect_instance.hpp"
#include "telltale/core/effects/wording.hpp"

namespace telltale {

class GnssLatencyEffect final : public Effect {
 public:
  GnssLatencyEffect()
      : Effect({.name = "gnss_latency",
                .title = "old GNSS positions",
                .equation = "p_measured(t) = p(t - L)",
                .source =
                    "Latency of GNSS receivers: Skog and Haendel, Time synchronization errors "
                    "in loosely coupled GPS-aided inertial navigation, IEEE T-ITS 12, 2011",
                .parameters = {{"latency", "s", 0.2, -0.5, 1.5}},
                .settled_by = "the receiver's own time stamps"}) {}

  std::string Describe(EffectValues values) const override {
    return "positions " + FormatNumber(values[0], 2) + " s old";
  }

  double LatencyS(EffectValues values) const override { return values[0]; }
};

template const Effect& InstanceOf<GnssLatencyEffect>();

}  // namespace telltale
