#pragma once

namespace blind::truth {

inline constexpr double kNeutralUs = 1500.0;
inline constexpr double kFullUs = 400.0;  // from neutral to either full command

/// Thrust of a T200 standing still at 16 V, newtons, by linear interpolation of a table: nothing
/// from 1471 to 1529 us, 5.25 kgf at 1900 us, -4.1 kgf at 1100 us, held beyond.
double BollardThrust(double pulse_us);

/// The pulse as a thruster with a wider dead zone hears it: `widening_us` nearer to neutral.
double WithWiderDeadZone(double pulse_us, double widening_us);

/// Shaft speeds are in sqrt(newton): thrust is speed times its magnitude.
double ShaftSpeed(double thrust_n);
double ThrustAt(double shaft_speed);

/// What is left of thrust when the propeller moves through the water: `loss` is the share lost at
/// full forward command and 1.8 m/s, more at lower shaft speed, the other way astern.
double InflowShare(double loss, double shaft_speed, double speed_through_water_mps);

}  // namespace blind::truth
