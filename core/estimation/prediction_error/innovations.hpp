#pragma once

#include <vector>

#include "telltale/core/estimation/prediction_error/extended_kalman_filter.hpp"

namespace telltale {

/// The innovations of an extended Kalman filter along one segment: fixes north and east, headings.
std::vector<Innovation> InnovationsOf(const RawSignals& signals, const HeldCommands& commands,
                                      const FilterSettings& settings,
                                      std::vector<FilterGain>* gains = nullptr);

/// The same with the gains of another run over the same readings at the same nominal delay.
std::vector<Innovation> InnovationsWith(const std::vector<FilterGain>& gains,
                                        const RawSignals& signals, const HeldCommands& commands,
                                        const FilterSettings& settings);

}  // namespace telltale
