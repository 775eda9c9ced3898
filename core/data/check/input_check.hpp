#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/samples.hpp"
#include "telltale/core/vessel/vehicle.hpp"

namespace telltale {

/// What a channel holds, as its time stamps show it.
struct ChannelCheck {
  std::size_t samples = 0;
  double start_s = 0.0;
  double end_s = 0.0;
  double median_period_s = 0.0;  ///< 0 for fewer than two samples
  std::size_t gaps = 0;          ///< silences of more than five median periods and a second
  double longest_gap_s = 0.0;
};

/// What a recording holds and which faults of input it shows.
struct InputCheck {
  std::array<ChannelCheck, kChannels.size()> channels;  ///< in the order of kChannels
  /// Suspected faults, the most certain first: subject, evidence in numbers, remedy. A fault that
  /// hides others (wrong units) stands alone.
  std::vector<Refusal> faults;
};

/// Seeks faults of input that would give a wrong model: times in milliseconds or microseconds,
/// latitude and longitude exchanged, commands in shares, what the motion betrays
/// (MotionFaults), commands outside the vehicle's range. Units: as GnssFix,
/// HeadingSample and ThrusterSample have them. The samples need not be admitted.
InputCheck CheckInput(const std::vector<GnssFix>& gnss, const std::vector<HeadingSample>& heading,
                      const std::vector<ThrusterSample>& thrusters, const Vehicle& vehicle);

/// A fault of units that needs no vehicle to be seen: times in milliseconds or microseconds,
/// latitude and longitude exchanged, commands in shares or percent.
std::optional<Refusal> UnitFault(const std::vector<GnssFix>& gnss,
                                 const std::vector<ThrusterSample>& thrusters);

/// The most certain fault; nothing where the input shows none.
std::optional<Refusal> FirstFault(const InputCheck& check);

}  // namespace telltale
