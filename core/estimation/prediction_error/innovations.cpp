#include "telltale/core/estimation/prediction_error/innovations.hpp"

namespace telltale {
namespace {

// `prepare` says what the filter uses and records beside its innovations.
template <class Prepare>
std::vector<Innovation> Innovate(const RawSignals& signals, const HeldCommands& commands,
                                 const FilterSettings& settings, const Prepare& prepare) {
  const auto readings = ReadingsOf(signals, settings.nominal_fix_delay_s);
  const auto start = StartOf(readings);
  std::vector<Innovation> innovations;
  if (!start) return innovations;
  innovations.reserve(2 * readings.size());
  ExtendedKalmanFilter filter(settings, commands, readings.front().time_s, *start);
  prepare(filter);
  for (const Reading& reading : readings) filter.Take(reading, innovations);
  return innovations;
}

}  // namespace

std::vector<Innovation> InnovationsOf(const RawSignals& signals, const HeldCommands& commands,
                                      const FilterSettings& settings) {
  return Innovate(signals, commands, settings, [](ExtendedKalmanFilter&) {});
}

std::vector<std::vector<Innovation>> InnovationsUnder(const std::vector<NoiseModel>& noises,
                                                      const RawSignals& signals,
                                                      const HeldCommands& commands,
                                                      const FilterSettings& settings) {
  std::vector<NoiseVariation> variations;
  for (const NoiseModel& noise : noises) {
    variations.emplace_back(
        CovarianceFilter(noise, settings.current_sigma_m_s, settings.misalignment_sigma_rad));
  }
  Innovate(signals, commands, settings,
           [&](ExtendedKalmanFilter& filter) { filter.RunBeside(&variations); });
  std::vector<std::vector<Innovation>> all;
  for (NoiseVariation& variation : variations) all.push_back(variation.TakeInnovations());
  return all;
}

SlopedInnovations SlopedInnovationsOf(const RawSignals& signals, const HeldCommands& commands,
                                      const FilterSettings& settings, bool with_instruments) {
  SlopedInnovations all;
  const std::size_t most = 2 * signals.north_m.times_s.size() + signals.psi_rad.times_s.size();
  all.slopes.reserve(most);
  all.gains.reserve(most);
  all.innovations = Innovate(signals, commands, settings, [&](ExtendedKalmanFilter& filter) {
    filter.UseGains(nullptr, &all.gains);
    filter.RecordSlopes(&all.slopes, with_instruments);
  });
  return all;
}

std::vector<Innovation> InnovationsWith(const std::vector<FilterGain>& gains,
                                        const RawSignals& signals, const HeldCommands& commands,
                                        const FilterSettings& settings) {
  return Innovate(signals, commands, settings,
                  [&](ExtendedKalmanFilter& filter) { filter.UseGains(&gains, nullptr); });
}

}  // namespace telltale
