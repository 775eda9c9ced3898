#pragma once

#include <cstddef>

#include "alter/telemetry.hpp"

namespace blind::alter {

/// What a compass that shows `degrees` too much would have logged, in [0, 360).
void TurnHeading(Telemetry& telemetry, double degrees);

/// What a receiver that stamps its fixes `seconds` too late would have logged: the position of
/// then, now.
void DelayFixes(Telemetry& telemetry, double seconds);

/// What would have been logged if thrusters answered `seconds` later than they did: the same answer
/// to commands that much earlier.
void ShiftCommands(Telemetry& telemetry, double seconds);

/// What a receiver with its antenna so far from where it was would have logged: every fix moved by
/// (forward, starboard) turned by the heading then, which is interpolated. Fixes without a heading
/// before and after are dropped; returns how many.
std::size_t MoveAntenna(Telemetry& telemetry, double forward_m, double starboard_m);

enum class Side { kPort, kStarboard };

/// Pulse widths of one channel; reverse lies on the other side of neutral than forward.
struct Channel {
  double neutral_us = 1500.0;
  double full_forward_us = 1900.0;
  double full_reverse_us = 1100.0;
};

/// The steady thrust of a propeller, up to its unit: with e = |delta| less the dead band ahead or
/// in reverse, above zero, linear e + quadratic e^2; zero within the dead band. delta is the share
/// of full command. By default delta |delta|.
struct ThrustCurve {
  double forward_linear = 0.0;
  double forward_quadratic = 1.0;
  double reverse_linear = 0.0;
  double reverse_quadratic = 1.0;
  double forward_dead_band = 0.0;
  double reverse_dead_band = 0.0;
};

/// What a boat whose one side gives `lost` of its thrust away, [0, 0.9], would have had to command
/// for the motion that was recorded: the command whose thrust by `curve` is 1 / (1 - lost) times as
/// large, no further than +-1. Commands within the dead band stay. Returns how many rows were cut
/// at +-1.
std::size_t Weaken(Telemetry& telemetry, Side side, double lost, const Channel& channel,
                   const ThrustCurve& curve = {});

}  // namespace blind::alter
