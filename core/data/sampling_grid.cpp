#include "telltale/core/data/sampling_grid.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "telltale/core/base/median.hpp"

namespace telltale {
namespace {

double MedianPeriod(const std::vector<GnssFix>& fixes) {
  std::vector<double> periods;
  for (std::size_t i = 1; i < fixes.size(); ++i) {
    periods.push_back(fixes[i].time_s - fixes[i - 1].time_s);
  }
  return periods.empty() ? kLongestPeriodS : Median(std::move(periods));
}

}  // namespace

std::vector<double> SamplingGrid::Map(const std::function<double(double)>& value_at) const {
  std::vector<double> values(rows);
  for (std::size_t row = 0; row < rows; ++row) values[row] = value_at(Time(row));
  return values;
}

double SamplingPeriod(const std::vector<GnssFix>& fixes, const PrepareOptions& options) {
  if (options.sampling_period_s) return *options.sampling_period_s;
  const double rounded = std::round(MedianPeriod(fixes) * 100.0) / 100.0;
  return std::clamp(rounded, kShortestPeriodS, kLongestPeriodS);
}

SamplingGrid LayGrid(const Recording& recording, const Segment& segment, double period_s) {
  const RowRange& samples = segment.Of(Channel::kGnss);
  const auto fixes = std::span(recording.gnss).subspan(samples.begin, samples.size());
  const auto first = std::find_if(fixes.begin(), fixes.end(), [&](const GnssFix& fix) {
    return fix.time_s >= segment.start_s - kSameInstantS;
  });
  if (first == fixes.end() || first->time_s > segment.end_s) return {};
  const double intervals = std::floor((segment.end_s + kSameInstantS - first->time_s) / period_s);
  return {first->time_s, period_s, static_cast<std::size_t>(intervals) + 1};
}

bool LongEnough(const SamplingGrid& grid, const PrepareOptions& options) {
  const std::size_t window = 2 * options.smoothing_half_width + 1;
  const double duration = grid.rows == 0 ? 0.0 : grid.Time(grid.rows - 1) - grid.start_s;
  return grid.rows >= window && duration >= options.shortest_segment_s - kSameInstantS;
}

double SamplesPerRow(const TimeSeries& series, const SamplingGrid& grid) {
  const double span = series.times_s.back() - series.times_s.front();
  return static_cast<double>(series.times_s.size() - 1) * grid.period_s / span;
}

bool IsAveraged(const TimeSeries& series, const SamplingGrid& grid) {
  return SamplesPerRow(series, grid) > 1.9;
}

std::vector<double> OntoGrid(const TimeSeries& series, const SamplingGrid& grid) {
  if (IsAveraged(series, grid)) {
    return grid.Map([&](double t) { return series.MeanAbout(t, grid.period_s); });
  }
  return grid.Map([&](double t) { return series.Interpolate(t); });
}

}  // namespace telltale
