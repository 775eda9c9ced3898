#include "telltale/core/vessel/propellers.hpp"

#include <algorithm>
#include <cmath>

namespace telltale {

double PwmChannel::Normalise(double pulse_us) const {
  const double offset = pulse_us - neutral_us;
  const double forward_span = full_forward_us - neutral_us;
  const double reverse_span = full_reverse_us - neutral_us;
  const bool forward = offset * forward_span >= 0.0;
  const double delta = forward ? offset / forward_span : -offset / reverse_span;
  return std::clamp(delta, -1.0, 1.0);
}

double PwmChannel::PulseWidth(double delta) const {
  const double full_us = delta >= 0.0 ? full_forward_us : full_reverse_us;
  return neutral_us + std::abs(delta) * (full_us - neutral_us);
}

double DeadZone::Apply(double delta) const {
  if (delta >= forward) return delta - forward;
  if (delta <= reverse) return delta - reverse;
  return 0.0;
}

PropellerCommand DeadZone::Apply(const PropellerCommand& delta) const {
  return {Apply(delta.port), Apply(delta.starboard)};
}

PropellerRegion RegionOf(const PropellerCommand& command) {
  const bool port_forward = command.port >= -kIdleCommand;
  const bool starboard_forward = command.starboard >= -kIdleCommand;
  if (port_forward) return starboard_forward ? PropellerRegion::kFF : PropellerRegion::kFR;
  return starboard_forward ? PropellerRegion::kRF : PropellerRegion::kRR;
}

std::string_view Name(PropellerRegion region) {
  switch (region) {
    case PropellerRegion::kFF: return "FF";
    case PropellerRegion::kFR: return "FR";
    case PropellerRegion::kRF: return "RF";
    case PropellerRegion::kRR: return "RR";
  }
  return "";
}

}  // namespace telltale
