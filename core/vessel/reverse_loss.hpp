#pragma once

#include <algorithm>
#include <cmath>

namespace telltale {

/// What a propeller keeps of its thrust in reverse while the boat moves ahead. A small electric
/// thruster that turns ahead with the water starts in reverse only where it overcomes that.
/// Model: docs/concepts/physical-model.md (105a), share = 1 / (1 + (u / u_h)^8) for u > 0, else 1;
/// u_h, the speed through the water at which half is left, is one over `per_speed`. An
/// approximation of a change that is steep on the BlueBoat. Units: u in m/s, per_speed in s/m, >=
/// 0; 0 is no loss.
struct ReverseLoss {
  double per_speed = 0.0;

  double Share(double u) const { return 1.0 / (1.0 + Steepness(u)); }

  /// d share / d u and d share / d per_speed.
  double ByU(double u) const { return u > 0.0 ? -kPower * Slope(u) / u : 0.0; }
  double ByPerSpeed(double u) const {
    return per_speed > 0.0 ? -kPower * Slope(u) / per_speed : 0.0;
  }

  bool operator==(const ReverseLoss&) const = default;

 private:
  static constexpr double kPower = 8.0;

  double Steepness(double u) const {
    const double x2 = std::pow(std::max(u, 0.0) * per_speed, 2);
    return x2 * x2 * x2 * x2;
  }
  double Slope(double u) const {
    const double share = Share(u);
    return Steepness(u) * share * share;
  }
};

}  // namespace telltale
