#include "telltale/core/estimation/prediction_error/innovations.hpp"

namespace telltale {
namespace {

std::vector<Innovation> Innovate(const RawSignals& signals, const HeldCommands& commands,
                                 const FilterSettings& settings,
                                 const std::vector<FilterGain>* fixed,
                                 std::vector<FilterGain>* record) {
  const auto readings = ReadingsOf(signals, settings.nominal_fix_delay_s);
  const auto start = StartOf(readings);
  std::vector<Innovation> innovations;
  if (!start) return innovations;
  innovations.reserve(2 * readings.size());
  ExtendedKalmanFilter filter(settings, commands, readings.front().time_s, *start);
  filter.UseGains(fixed, record);
  for (const Reading& reading : readings) filter.Take(reading, innovations);
  return innovations;
}

}  // namespace

std::vector<Innovation> InnovationsOf(const RawSignals& signals, const HeldCommands& commands,
                                      const FilterSettings& settings,
                                      std::vector<FilterGain>* gains) {
  return Innovate(signals, commands, settings, nullptr, gains);
}

std::vector<Innovation> InnovationsWith(const std::vector<FilterGain>& gains,
                                        const RawSignals& signals, const HeldCommands& commands,
                                        const FilterSettings& settings) {
  return Innovate(signals, commands, settings, &gains, nullptr);
}

}  // namespace telltale
