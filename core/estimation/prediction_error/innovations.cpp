#include "telltale/core/estimation/prediction_error/innovations.hpp"

namespace telltale {
namespace {

// `prepare` says what the filter uses and records beside its innovations, of which there are so
// many at most.
template <class Prepare>
std::vector<Innovation> Innovate(const RawSignals& signals, const HeldCommands& commands,
                                 const FilterSettings& settings, const Prepare& prepare) {
  const auto readings = ReadingsOf(signals, settings.nominal_fix_delay_s);
  const auto start = StartOf(readings);
  std::vector<Innovation> innovations;
  if (!start) return innovations;
  const std::size_t most = 2 * readings.size();
  innovations.reserve(most);
  ExtendedKalmanFilter filter(settings, commands, readings.front().time_s, *start);
  prepare(filter, most);
  for (const Reading& reading : readings) filter.Take(reading, innovations);
  return innovations;
}

}  // namespace

std::vector<Innovation> InnovationsOf(const RawSignals& signals, const HeldCommands& commands,
                                      const FilterSettings& settings) {
  return Innovate(signals, commands, settings, [](ExtendedKalmanFilter&, std::size_t) {});
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
           [&](ExtendedKalmanFilter& filter, std::size_t) { filter.RunBeside(&variations); });
  std::vector<std::vector<Innovation>> all;
  for (NoiseVariation& variation : variations) all.push_back(variation.TakeInnovations());
  return all;
}

SlopedInnovations SlopedInnovationsOf(const RawSignals& signals, const HeldCommands& commands,
                                      const FilterSettings& settings, bool with_instruments) {
  SlopedInnovations all;
  all.innovations =
      Innovate(signals, commands, settings, [&](ExtendedKalmanFilter& filter, std::size_t most) {
        all.gains.reserve(most);
        all.slopes.reserve(most);
        filter.UseGains(nullptr, &all.gains);
        filter.RecordSlopes(&all.slopes, with_instruments);
      });
  return all;
}

std::vector<Innovation> InnovationsWith(const std::vector<FilterGain>& gains,
                                        const RawSignals& signals, const HeldCommands& commands,
                                        const FilterSettings& settings) {
  return Innovate(signals, commands, settings, [&](ExtendedKalmanFilter& filter, std::size_t) {
    filter.UseGains(&gains, nullptr);
  });
}

}  // namespace telltale
