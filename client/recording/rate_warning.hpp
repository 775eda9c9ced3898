#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "telltale/core/base/format_number.hpp"
#include "telltale/core/base/median.hpp"

namespace telltale {

/// Rates below which a channel changes unseen.
inline constexpr double kLowOutputHz = 5.0;
inline constexpr double kLowHeadingHz = 4.0;
inline constexpr double kLowPositionHz = 0.9;

/// How many periods give the median of a long recording well enough.
inline constexpr std::size_t kEnoughPeriods = 100'000;

inline double TimeIn(double time_s) {
  return time_s;
}
template <class Sample>
double TimeIn(const Sample& sample) {
  return sample.time_s;
}

/// "; SERVO_OUTPUT_RAW comes at 2 Hz only: set ..." where the samples, or times, come more seldom
/// than `least_hz`, by the median of their periods; else empty.
template <class Sample>
std::string RateWarning(const std::string& source, const std::vector<Sample>& samples,
                        double least_hz, const std::string& remedy) {
  std::vector<double> periods_s;
  const std::size_t step = 1 + samples.size() / kEnoughPeriods;
  for (std::size_t i = 1; i < samples.size(); i += step) {
    const double period_s = TimeIn(samples[i]) - TimeIn(samples[i - 1]);
    if (period_s > 0.0) periods_s.push_back(period_s);
  }
  if (periods_s.empty()) return {};
  const double rate_hz = 1.0 / Median(std::move(periods_s));
  if (rate_hz >= least_hz) return {};
  return "; " + source + " comes at " + FormatNumber(rate_hz, 1) + " Hz only: " + remedy;
}

}  // namespace telltale
