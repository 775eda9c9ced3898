#pragma once

namespace telltale {

/// How long a live source of samples may be silent before the next best one counts.
inline constexpr double kSourcePatienceS = 3.0;

/// How long it may take to learn whose clock the times of a vehicle are of.
inline constexpr double kClockPatienceS = 3.0;

}  // namespace telltale
