#include "telltale/core/validation/physical_free_runs.hpp"

#include <algorithm>

#include "telltale/core/data/preparation.hpp"

namespace telltale {
namespace {

// Beyond the ends of a grid, for what is interpolated there.
constexpr double kMarginS = 1.0;

}  // namespace

PhysicalFreeRuns::PhysicalFreeRuns(const PreparedDataset& dataset, const PhysicalModel& model)
    : dataset_(dataset) {
  settings_.parameters = model.Estimates();
  settings_.noise = model.noise;
  settings_.propeller_separation_m = model.propeller_separation_m;
  settings_.antenna = dataset.sensors.antenna;
  settings_.nominal_fix_delay_s = FixDelay();
}

double PhysicalFreeRuns::FixDelay() const {
  return settings_.parameters[At(FossenParameter::kFixDelay)];
}

// A fix that is late tells of an earlier time: until the row, of none after this one.
double PhysicalFreeRuns::StartTimeOf(std::size_t row) const {
  return dataset_.rows[row].time_s - std::max(FixDelay(), 0.0);
}

// A start is known from the readings that its recorded row is made of, and from those before.
std::vector<FilterState> PhysicalFreeRuns::StatesAt(std::size_t segment,
                                                    const std::vector<std::size_t>& rows) const {
  std::vector<SmoothingWindow> windows;
  for (const std::size_t row : rows) {
    const RowRange about = RowsAbout({row, row + 1}, dataset_.segments[segment]);
    const double ahead_s = dataset_.rows[about.end - 1].time_s - dataset_.rows[row].time_s;
    windows.push_back({StartTimeOf(row), StartTimeOf(row) + ahead_s});
  }
  return SmoothedStates(dataset_.signals[segment], dataset_.commands[segment], settings_, windows);
}

std::vector<FilterState> PhysicalFreeRuns::Predict(const Start& start,
                                                   std::span<const double> stamps_s,
                                                   double delay_s) const {
  std::vector<double> times_s;
  for (const double stamp_s : stamps_s) times_s.push_back(stamp_s - delay_s);
  return PredictedStates(start.state, StartTimeOf(start.row), dataset_.commands[start.segment],
                         settings_, times_s);
}

void PhysicalFreeRuns::PredictHeadings(const Start& start, TimeSeries& psi_rad) const {
  std::size_t at = psi_rad.CountUntil(dataset_.rows[start.row].time_s);
  for (const FilterState& x : Predict(start, std::span(psi_rad.times_s).subspan(at), 0.0)) {
    psi_rad.values[at++] = HeadingOf(x);
  }
}

void PhysicalFreeRuns::PredictFixes(const Start& start, RawSignals& signals) const {
  std::size_t at = signals.north_m.CountUntil(dataset_.rows[start.row].time_s);
  const auto stamps_s = std::span(signals.north_m.times_s).subspan(at);
  for (const FilterState& x : Predict(start, stamps_s, FixDelay())) {
    const Eigen::Vector2d fix = FixOf(x, settings_.antenna);
    signals.north_m.values[at] = fix[0];
    signals.east_m.values[at] = fix[1];
    ++at;
  }
}

SegmentSignals PhysicalFreeRuns::Readings(const Start& start, const SamplingGrid& grid) const {
  const RawSignals& recorded = dataset_.signals[start.segment];
  const auto about_grid = [&grid](const TimeSeries& series) {
    return series.Within(grid.start_s - kMarginS, grid.Time(grid.rows - 1) + kMarginS);
  };
  SegmentSignals signals{
      {about_grid(recorded.north_m), about_grid(recorded.east_m), about_grid(recorded.psi_rad)},
      dataset_.commands[start.segment]};
  PredictHeadings(start, signals.psi_rad);
  PredictFixes(start, signals);
  return signals;
}

// The rows that the filter reaches from those of the run. At the ends of a segment it has its whole
// window on one side.
RowRange PhysicalFreeRuns::RowsAbout(const RowRange& run, const RowRange& segment) const {
  const std::size_t half = dataset_.options.smoothing_half_width;
  const std::size_t window = 2 * half + 1;
  const std::size_t begin = run.begin - std::min(half, run.begin - segment.begin);
  const std::size_t end = std::max(run.end + half, segment.begin + window);
  return {std::min(begin, segment.end - window), std::min(end, segment.end)};
}

std::vector<PreparedRow> PhysicalFreeRuns::Run(const Start& start, std::size_t rows) const {
  const RowRange run{start.row, start.row + rows + 1};
  const RowRange about = RowsAbout(run, dataset_.segments[start.segment]);
  const SamplingGrid grid{dataset_.rows[about.begin].time_s, dataset_.sampling_period_s,
                          about.size()};
  auto predicted = PrepareRows(Readings(start, grid), grid, settings_.antenna, dataset_.options);
  predicted.resize(run.end - about.begin);
  predicted.erase(predicted.begin(),
                  predicted.begin() + static_cast<std::ptrdiff_t>(run.begin - about.begin));
  // From the measured position on, as every free run.
  const Eta& measured = dataset_.rows[start.row].eta;
  const Eta from = predicted.front().eta;
  for (PreparedRow& row : predicted) {
    row.eta.x_m += measured.x_m - from.x_m;
    row.eta.y_m += measured.y_m - from.y_m;
  }
  return predicted;
}

}  // namespace telltale
