#include "thruster.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace blind::truth {
namespace {

constexpr double kNewtonsPerKgf = 9.80665;

struct Point {
  double from_neutral_us;
  double thrust_kgf;
};

constexpr std::array<Point, 17> kForward{{{29, 0.0},
                                          {36, 0.03},
                                          {50, 0.13},
                                          {75, 0.36},
                                          {100, 0.64},
                                          {125, 0.95},
                                          {150, 1.27},
                                          {175, 1.60},
                                          {200, 1.93},
                                          {225, 2.29},
                                          {250, 2.66},
                                          {275, 3.06},
                                          {300, 3.45},
                                          {325, 3.88},
                                          {350, 4.34},
                                          {375, 4.80},
                                          {400, 5.25}}};

constexpr std::array<Point, 17> kReverse{{{29, 0.0},
                                          {36, 0.02},
                                          {50, 0.10},
                                          {75, 0.28},
                                          {100, 0.50},
                                          {125, 0.74},
                                          {150, 0.99},
                                          {175, 1.25},
                                          {200, 1.51},
                                          {225, 1.79},
                                          {250, 2.09},
                                          {275, 2.40},
                                          {300, 2.71},
                                          {325, 3.05},
                                          {350, 3.41},
                                          {375, 3.77},
                                          {400, 4.10}}};

double Interpolated(const std::array<Point, 17>& table, double from_neutral_us) {
  if (from_neutral_us <= table.front().from_neutral_us) return 0.0;
  if (from_neutral_us >= table.back().from_neutral_us) return table.back().thrust_kgf;
  const auto after = std::upper_bound(
      table.begin(), table.end(), from_neutral_us,
      [](double value, const Point& point) { return value < point.from_neutral_us; });
  const auto before = after - 1;
  const double share = (from_neutral_us - before->from_neutral_us) /
                       (after->from_neutral_us - before->from_neutral_us);
  return before->thrust_kgf + share * (after->thrust_kgf - before->thrust_kgf);
}

}  // namespace

double BollardThrust(double pulse_us) {
  const double offset = pulse_us - kNeutralUs;
  return kNewtonsPerKgf *
         (offset >= 0.0 ? Interpolated(kForward, offset) : -Interpolated(kReverse, -offset));
}

double WithWiderDeadZone(double pulse_us, double widening_us) {
  const double offset = pulse_us - kNeutralUs;
  return kNeutralUs + std::copysign(std::max(std::abs(offset) - widening_us, 0.0), offset);
}

double ShaftSpeed(double thrust_n) {
  return std::copysign(std::sqrt(std::abs(thrust_n)), thrust_n);
}

double ThrustAt(double shaft_speed) {
  return shaft_speed * std::abs(shaft_speed);
}

double InflowShare(double loss, double shaft_speed, double speed_through_water_mps) {
  constexpr double kFullShaftSpeed = 7.1753;  // of 5.25 kgf
  constexpr double kReferenceSpeedMps = 1.8;
  const double advance = std::copysign(speed_through_water_mps / kReferenceSpeedMps,
                                       speed_through_water_mps * shaft_speed);
  const double turning = 0.35 + 0.65 * std::abs(shaft_speed) / kFullShaftSpeed;
  return std::clamp(1.0 - loss * advance / turning, 0.2, 1.3);
}

}  // namespace blind::truth
