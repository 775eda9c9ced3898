#pragma once

#include <vector>

#include "telltale/core/estimation/prediction_error/extended_kalman_filter.hpp"

namespace telltale {

/// The innovations of an extended Kalman filter along one segment: fixes north and east, headings.
std::vector<Innovation> InnovationsOf(const RawSignals& signals, const HeldCommands& commands,
                                      const FilterSettings& settings);

/// The same under each of several noises near that of `settings`, from one run; NoiseVariation.
std::vector<std::vector<Innovation>> InnovationsUnder(const std::vector<NoiseModel>& noises,
                                                      const RawSignals& signals,
                                                      const HeldCommands& commands,
                                                      const FilterSettings& settings);

/// Innovations with what each changes by with the parameters, and the gains that they were taken
/// with. Shapes: of each the same number.
struct SlopedInnovations {
  std::vector<Innovation> innovations;
  std::vector<InnovationSlope> slopes;
  std::vector<FilterGain> gains;
};

SlopedInnovations SlopedInnovationsOf(const RawSignals& signals, const HeldCommands& commands,
                                      const FilterSettings& settings, bool with_instruments);

/// The innovations with the gains of another run over the same readings at the same nominal delay.
std::vector<Innovation> InnovationsWith(const std::vector<FilterGain>& gains,
                                        const RawSignals& signals, const HeldCommands& commands,
                                        const FilterSettings& settings);

}  // namespace telltale
