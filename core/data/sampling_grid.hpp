#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "telltale/core/data/prepare_options.hpp"
#include "telltale/core/data/samples.hpp"
#include "telltale/core/data/segments.hpp"
#include "telltale/core/data/time_series.hpp"

namespace telltale {

/// Equally spaced instants of one segment.
struct SamplingGrid {
  double start_s = 0.0;
  double period_s = 0.0;
  std::size_t rows = 0;

  double Time(std::size_t row) const { return start_s + static_cast<double>(row) * period_s; }

  std::vector<double> Map(const std::function<double(double)>& value_at) const;
};

/// The period that the options ask for, else the median period between fixes, rounded to 10 ms so
/// that jitter of the stamps does not show in it.
double SamplingPeriod(const std::vector<GnssFix>& fixes, const PrepareOptions& options);

/// The grid of a segment. It starts on the segment's first fix, since the other channels are
/// brought to the GNSS clock, and has no rows where the segment holds no fix.
SamplingGrid LayGrid(const Recording& recording, const Segment& segment, double period_s);

/// Whether a grid fills the smoothing window and lasts for the shortest segment.
bool LongEnough(const SamplingGrid& grid, const PrepareOptions& options);

/// Samples of a series in one period of the grid, on average.
double SamplesPerRow(const TimeSeries& series, const SamplingGrid& grid);

/// Whether a sensor is fast enough to be averaged about each grid point: about two samples a row.
bool IsAveraged(const TimeSeries& series, const SamplingGrid& grid);

/// A series on a grid: averaged about each grid point or interpolated at it.
std::vector<double> OntoGrid(const TimeSeries& series, const SamplingGrid& grid);

}  // namespace telltale
