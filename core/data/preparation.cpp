#include "telltale/core/data/preparation.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>
#include <utility>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/base/median.hpp"
#include "telltale/core/base/range.hpp"
#include "telltale/core/data/heading_unwrap.hpp"
#include "telltale/core/data/held_commands.hpp"
#include "telltale/core/data/north_east_frame.hpp"
#include "telltale/core/data/savitzky_golay.hpp"
#include "telltale/core/data/segments_and_slices.hpp"
#include "telltale/core/data/time_series.hpp"
#include "telltale/core/data/white_noise_estimate.hpp"

namespace telltale {
namespace {

constexpr double kShortestPeriodS = 0.02;
constexpr double kLongestPeriodS = 2.0;

/// What was recorded along one segment, not yet on a grid.
struct Signals : RawSignals {
  HeldCommands commands;
};

/// Equally spaced instants of one segment.
struct Grid {
  double start_s = 0.0;
  double period_s = 0.0;
  std::size_t rows = 0;

  double Time(std::size_t row) const { return start_s + static_cast<double>(row) * period_s; }

  std::vector<double> Map(const std::function<double(double)>& value_at) const {
    std::vector<double> values(rows);
    for (std::size_t row = 0; row < rows; ++row) values[row] = value_at(Time(row));
    return values;
  }
};

/// Body-origin positions on a grid.
struct Path {
  std::vector<double> x_m;
  std::vector<double> y_m;
};

template <class Sample>
void RequireAscending(const std::vector<Sample>& samples) {
  const auto not_ascending = [](const Sample& a, const Sample& b) { return a.time_s >= b.time_s; };
  Require(std::adjacent_find(samples.begin(), samples.end(), not_ascending) == samples.end(),
          "a recording in order of time without duplicates");
}

template <class Sample>
std::span<const Sample> Slice(const std::vector<Sample>& samples, const RowRange& range) {
  return std::span(samples).subspan(range.begin, range.size());
}

Signals ReadSignals(const Recording& recording, const Segment& segment, const Vehicle& vehicle,
                    const NorthEastFrame& frame) {
  Signals signals{
      {}, HeldCommands(Slice(recording.thrusters, segment.Of(Channel::kThrusters)), vehicle)};
  for (const GnssFix& fix : Slice(recording.gnss, segment.Of(Channel::kGnss))) {
    const NorthEastPosition antenna = frame.Forward({fix.latitude_deg, fix.longitude_deg});
    signals.north_m.times_s.push_back(fix.time_s);
    signals.north_m.values.push_back(antenna.north_m);
    signals.east_m.values.push_back(antenna.east_m);
  }
  signals.east_m.times_s = signals.north_m.times_s;
  const auto headings = Slice(recording.heading, segment.Of(Channel::kHeading));
  for (const HeadingSample& sample : headings) signals.psi_rad.times_s.push_back(sample.time_s);
  signals.psi_rad.values = Unwrap(headings);
  return signals;
}

double MedianPeriod(const std::vector<GnssFix>& fixes) {
  std::vector<double> periods;
  for (std::size_t i = 1; i < fixes.size(); ++i) {
    periods.push_back(fixes[i].time_s - fixes[i - 1].time_s);
  }
  return periods.empty() ? kLongestPeriodS : Median(std::move(periods));
}

// Rounded to 10 ms, so that jitter of the stamps does not show in the period.
double SamplingPeriod(const std::vector<GnssFix>& fixes, const PrepareOptions& options) {
  if (options.sampling_period_s) return *options.sampling_period_s;
  const double rounded = std::round(MedianPeriod(fixes) * 100.0) / 100.0;
  return std::clamp(rounded, kShortestPeriodS, kLongestPeriodS);
}

// The grid starts on the first fix of the segment: it is the GNSS clock the others are brought to.
Grid LayGrid(const Recording& recording, const Segment& segment, double period_s) {
  const auto fixes = Slice(recording.gnss, segment.Of(Channel::kGnss));
  const auto first = std::find_if(fixes.begin(), fixes.end(), [&](const GnssFix& fix) {
    return fix.time_s >= segment.start_s - kSameInstantS;
  });
  if (first == fixes.end() || first->time_s > segment.end_s) return {};
  const double intervals = std::floor((segment.end_s + kSameInstantS - first->time_s) / period_s);
  return {first->time_s, period_s, static_cast<std::size_t>(intervals) + 1};
}

bool LongEnough(const Grid& grid, const PrepareOptions& options) {
  const std::size_t window = 2 * options.smoothing_half_width + 1;
  const double duration = grid.rows == 0 ? 0.0 : grid.Time(grid.rows - 1) - grid.start_s;
  return grid.rows >= window && duration >= options.shortest_segment_s - kSameInstantS;
}

// The antenna sits at p + R(psi) l.
void RemoveLeverArm(Path& path, std::span<const double> psi, const LeverArm& arm) {
  for (std::size_t row = 0; row < psi.size(); ++row) {
    const double c = std::cos(psi[row]);
    const double s = std::sin(psi[row]);
    path.x_m[row] -= c * arm.forward_m - s * arm.starboard_m;
    path.y_m[row] -= s * arm.forward_m + c * arm.starboard_m;
  }
}

// R(psi)^T (dx, dy) / h.
Nu ToBody(double psi, double dx, double dy, double period_s) {
  const double c = std::cos(psi);
  const double s = std::sin(psi);
  return {(c * dx + s * dy) / period_s, (-s * dx + c * dy) / period_s, 0.0};
}

// Central differences per sample, one-sided at the ends.
std::vector<double> Differentiate(std::span<const double> series) {
  std::vector<double> slope(series.size());
  for (std::size_t row = 0; row < series.size(); ++row) {
    const std::size_t before = row == 0 ? 0 : row - 1;
    const std::size_t after = std::min(row + 1, series.size() - 1);
    slope[row] = (series[after] - series[before]) / static_cast<double>(after - before);
  }
  return slope;
}

std::vector<PreparedRow> EmptyRows(const Signals& signals, const Grid& grid) {
  std::vector<PreparedRow> rows(grid.rows);
  for (std::size_t row = 0; row < grid.rows; ++row) {
    const double t = grid.Time(row);
    rows[row].time_s = t;
    rows[row].region = signals.commands.MajorityRegion(t, t + grid.period_s);
  }
  return rows;
}

void FillPoses(std::vector<PreparedRow>& rows, const Path& path, std::span<const double> psi) {
  for (std::size_t row = 0; row < rows.size(); ++row) {
    rows[row].eta = {path.x_m[row], path.y_m[row], psi[row]};
  }
}

TimeSeries CommandSeries(const HeldCommands& commands, double PropellerCommand::*side) {
  TimeSeries series{commands.Times(), {}};
  for (const PropellerCommand& command : commands.Commands()) {
    series.values.push_back(command.*side);
  }
  return series;
}

void FillExtrapolatedCommands(std::vector<PreparedRow>& rows, const HeldCommands& commands) {
  constexpr std::size_t kCubic = 3;
  for (const auto side : {&PropellerCommand::port, &PropellerCommand::starboard}) {
    const TimeSeries series = CommandSeries(commands, side);
    for (PreparedRow& row : rows) {
      row.delta.*side = std::clamp(series.Extrapolate(row.time_s, kCubic), -1.0, 1.0);
    }
  }
}

std::vector<PreparedRow> PrepareAsPaper(const Signals& signals, const Grid& grid,
                                        const Vehicle& vehicle, const SavitzkyGolay& filter) {
  const auto cubic = [](const TimeSeries& series) {
    return [&series](double t) { return series.Extrapolate(t, 3); };
  };
  const auto psi = grid.Map([&](double t) { return signals.psi_rad.Extrapolate(t, 8); });
  Path path{grid.Map(cubic(signals.north_m)), grid.Map(cubic(signals.east_m))};
  RemoveLeverArm(path, psi, vehicle.gnss_antenna);

  const auto x_slope = Differentiate(path.x_m);
  const auto y_slope = Differentiate(path.y_m);
  const auto r_per_row = filter.Smooth(Differentiate(psi));
  std::vector<double> u(grid.rows);
  std::vector<double> v(grid.rows);
  for (std::size_t row = 0; row < grid.rows; ++row) {
    const Nu body = ToBody(psi[row], x_slope[row], y_slope[row], grid.period_s);
    u[row] = body.u;
    v[row] = body.v;
  }
  u = filter.Smooth(u);
  v = filter.Smooth(v);

  std::vector<PreparedRow> rows = EmptyRows(signals, grid);
  FillPoses(rows, path, psi);
  for (std::size_t row = 0; row < grid.rows; ++row) {
    rows[row].nu = {u[row], v[row], r_per_row[row] / grid.period_s};
  }
  FillExtrapolatedCommands(rows, signals.commands);
  return rows;
}

double SamplesPerRow(const TimeSeries& series, const Grid& grid) {
  const double span = series.times_s.back() - series.times_s.front();
  return static_cast<double>(series.times_s.size() - 1) * grid.period_s / span;
}

// A sensor faster than twice the grid is averaged about each grid point, a slower one interpolated.
bool IsAveraged(const TimeSeries& series, const Grid& grid) {
  return SamplesPerRow(series, grid) > 1.9;
}

std::vector<double> OntoGrid(const TimeSeries& series, const Grid& grid) {
  if (IsAveraged(series, grid)) {
    return grid.Map([&](double t) { return series.MeanAbout(t, grid.period_s); });
  }
  return grid.Map([&](double t) { return series.Interpolate(t); });
}

/// Mean body velocities of the intervals between grid points, as displacements a row.
struct Increments {
  std::vector<double> forward_m;
  std::vector<double> starboard_m;
};

// Turned into the body frame interval by interval, at the heading midway: a boat that turns on the
// spot or circles keeps u and v nearly constant, while its velocity north and east swings, which no
// low-degree polynomial over the window follows. The heading as it was measured, not smoothed:
// where a boat begins to turn a smoothed heading is off by what makes u look like sway, and its
// noise is next to nothing beside that of positions.
Increments BodyIncrements(const Path& path, std::span<const double> psi) {
  Increments increments;
  for (std::size_t row = 0; row + 1 < psi.size(); ++row) {
    const Nu body = ToBody(0.5 * (psi[row] + psi[row + 1]), path.x_m[row + 1] - path.x_m[row],
                           path.y_m[row + 1] - path.y_m[row], 1.0);
    increments.forward_m.push_back(body.u);
    increments.starboard_m.push_back(body.v);
  }
  return increments;
}

// nu(k+1) - nu(k) is a weighted sum of the changes between the mean velocities of neighbouring
// intervals, and the change across t_i is h times the triangular mean about t_i of the
// acceleration. The command is given those very weights, so that row k pairs the command with the
// velocity change it caused: docs/concepts/data-preparation.md (4).
std::vector<PropellerCommand> FilterAsVelocity(const HeldCommands& commands, const Grid& grid,
                                               const SavitzkyGolay& filter) {
  std::vector<PropellerCommand> about(grid.rows);
  for (std::size_t row = 0; row < grid.rows; ++row) {
    about[row] = commands.TriangularMean(grid.Time(row), grid.period_s);
  }
  const auto weight_of = [&](std::size_t row, std::size_t interval) {
    if (row >= grid.rows) return 0.0;
    const std::size_t start = filter.WindowStart(row, grid.rows);
    if (interval < start || interval + 1 >= start + filter.WindowLength()) return 0.0;
    return filter.IncrementWeight(row - start, interval - start);
  };
  std::vector<PropellerCommand> seen(grid.rows);
  for (std::size_t row = 0; row < grid.rows; ++row) {
    const std::size_t start = filter.WindowStart(row, grid.rows);
    // The last row has no successor; it keeps the weights its own window would hand on.
    const bool last = row + 1 == grid.rows;
    double weight = 0.0;
    for (std::size_t i = start; i + 1 < start + filter.WindowLength(); ++i) {
      weight = last ? weight_of(row, i) : weight + weight_of(row, i) - weight_of(row + 1, i);
      seen[row].port += weight * about[i + 1].port;
      seen[row].starboard += weight * about[i + 1].starboard;
    }
  }
  return seen;
}

std::vector<PreparedRow> PrepareRobustly(const Signals& signals, const Grid& grid,
                                         const Vehicle& vehicle, const SavitzkyGolay& filter) {
  const auto raw_psi = OntoGrid(signals.psi_rad, grid);
  const auto r_per_row = filter.Slope(raw_psi);
  Path path{OntoGrid(signals.north_m, grid), OntoGrid(signals.east_m, grid)};
  RemoveLeverArm(path, raw_psi, vehicle.gnss_antenna);
  const Increments increments = BodyIncrements(path, raw_psi);
  const auto u_per_row = filter.SlopeOfIncrements(increments.forward_m);
  const auto v_per_row = filter.SlopeOfIncrements(increments.starboard_m);
  const auto seen = FilterAsVelocity(signals.commands, grid, filter);

  std::vector<PreparedRow> rows = EmptyRows(signals, grid);
  FillPoses(rows, {filter.Smooth(path.x_m), filter.Smooth(path.y_m)}, filter.Smooth(raw_psi));
  for (std::size_t row = 0; row < grid.rows; ++row) {
    rows[row].nu = {u_per_row[row] / grid.period_s, v_per_row[row] / grid.period_s,
                    r_per_row[row] / grid.period_s};
    rows[row].delta = seen[row];
  }
  return rows;
}

std::vector<PreparedRow> PrepareSegment(const Signals& signals, const Grid& grid,
                                        const Vehicle& vehicle, const PrepareOptions& options) {
  const SavitzkyGolay filter(options.smoothing_half_width, options.smoothing_degree);
  return options.preset == Preset::kPaper ? PrepareAsPaper(signals, grid, vehicle, filter)
                                          : PrepareRobustly(signals, grid, vehicle, filter);
}

// The norm of the weights with which the values about a row make its slope, per row.
double SlopeNorm(const SavitzkyGolay& filter, const PrepareOptions& options) {
  const std::size_t centre = options.smoothing_half_width;
  if (options.preset == Preset::kRobust) return filter.SlopeWeights(centre).norm();
  // Central differences, then smoothed: value j enters the slopes at j - 1 and j + 1.
  const Eigen::RowVectorXd smooth = filter.ValueWeights(centre);
  Eigen::RowVectorXd slope = Eigen::RowVectorXd::Zero(smooth.size() + 2);
  slope.tail(smooth.size()) += smooth / 2.0;
  slope.head(smooth.size()) -= smooth / 2.0;
  return slope.norm();
}

/// One sigma of white noise on each signal, as it came.
struct SignalNoise {
  explicit SignalNoise(const Signals& signals)
      : north_m(WhiteNoise(signals.north_m)),
        east_m(WhiteNoise(signals.east_m)),
        psi_rad(WhiteNoise(signals.psi_rad)) {}

  double north_m;
  double east_m;
  double psi_rad;
};

// What is left of the noise on a signal where it stands on the grid.
double NoiseOnGrid(double noise, const TimeSeries& series, const Grid& grid,
                   const PrepareOptions& options) {
  const bool averaged = options.preset == Preset::kRobust && IsAveraged(series, grid);
  return averaged ? noise / std::sqrt(SamplesPerRow(series, grid)) : noise;
}

// Positions are turned into the body frame, so u and v share the noise of north and east alike.
Nu NoiseInVelocity(const SignalNoise& noise, const Signals& signals, const Grid& grid,
                   const PrepareOptions& options) {
  const SavitzkyGolay filter(options.smoothing_half_width, options.smoothing_degree);
  const double gain = SlopeNorm(filter, options) / grid.period_s;
  const double position_m = std::hypot(NoiseOnGrid(noise.north_m, signals.north_m, grid, options),
                                       NoiseOnGrid(noise.east_m, signals.east_m, grid, options)) /
                            std::sqrt(2.0);
  const double psi_rad = NoiseOnGrid(noise.psi_rad, signals.psi_rad, grid, options);
  return {gain * position_m, gain * position_m, gain * psi_rad};
}

std::vector<Segment> SegmentsOf(const Recording& recording, const PrepareOptions& options) {
  std::vector<Segment> segments = FindSegments(recording, options.longest_gap_s);
  if (!options.longest_segment_s) return segments;
  std::vector<Segment> parts;
  for (const Segment& segment : segments) {
    const auto cut = CutSegment(segment, recording, *options.longest_segment_s);
    parts.insert(parts.end(), cut.begin(), cut.end());
  }
  return parts;
}

std::optional<Refusal> MissingChannel(const Recording& recording) {
  const auto missing = [](Channel channel) {
    const std::string name(Name(channel));
    return Refusal{"data preparation", "the recording holds no " + name + " samples",
                   "check that the boat sends " + name + " and that its samples are not rejected"};
  };
  if (recording.gnss.empty()) return missing(Channel::kGnss);
  if (recording.heading.empty()) return missing(Channel::kHeading);
  if (recording.thrusters.empty()) return missing(Channel::kThrusters);
  return std::nullopt;
}

Refusal NoSegment(const PrepareOptions& options, double period_s, double longest_found_s) {
  const double window_s = 2.0 * static_cast<double>(options.smoothing_half_width) * period_s;
  std::ostringstream reason;
  reason << "the longest segment in which no channel is silent for more than "
         << options.longest_gap_s << " s lasts " << longest_found_s << " s, and "
         << std::max(options.shortest_segment_s, window_s) << " s are needed";
  return {"data preparation", reason.str(),
          "record longer without interruptions, or allow a longer longest_gap_s"};
}

void Append(PreparedDataset& dataset, const std::vector<PreparedRow>& rows,
            const PrepareOptions& options) {
  const RowRange segment{dataset.rows.size(), dataset.rows.size() + rows.size()};
  dataset.rows.insert(dataset.rows.end(), rows.begin(), rows.end());
  dataset.segments.push_back(segment);
  const auto longest = static_cast<std::size_t>(
      std::max(1.0, std::floor(options.longest_slice_s / dataset.sampling_period_s + 1e-9)));
  const auto slices = CutSlices(dataset.rows, segment, longest);
  dataset.slices.insert(dataset.slices.end(), slices.begin(), slices.end());
}

double MeanPeriod(const TimeSeries& series) {
  const auto& times = series.times_s;
  return times.size() < 2 ? 0.0
                          : (times.back() - times.front()) / static_cast<double>(times.size() - 1);
}

// Means over segments, each with the weight of its rows, noises by their squares; call after
// Append.
void PoolSensors(PreparedDataset& dataset, const Signals& signals, const SignalNoise& noise) {
  const double share = static_cast<double>(dataset.segments.back().size()) /
                       static_cast<double>(dataset.rows.size());
  const auto pool = [&](double& so_far, double here) { so_far += share * (here - so_far); };
  const auto pool_square = [&](double& so_far, double here) {
    so_far = std::sqrt((1.0 - share) * so_far * so_far + share * here * here);
  };
  pool(dataset.sensors.gnss_period_s, MeanPeriod(signals.north_m));
  pool(dataset.sensors.heading_period_s, MeanPeriod(signals.psi_rad));
  pool_square(dataset.sensors.position_noise_m,
              std::hypot(noise.north_m, noise.east_m) / std::sqrt(2.0));
  pool_square(dataset.sensors.heading_noise_rad, noise.psi_rad);
}

// Root mean square over segments, each with the weight of its rows; call after Append.
void PoolNoise(PreparedDataset& dataset, const Nu& of_segment) {
  const double share = static_cast<double>(dataset.segments.back().size()) /
                       static_cast<double>(dataset.rows.size());
  for (const auto velocity : {&Nu::u, &Nu::v, &Nu::r}) {
    const double so_far = dataset.nu_noise.*velocity;
    const double here = of_segment.*velocity;
    dataset.nu_noise.*velocity = std::sqrt((1.0 - share) * so_far * so_far + share * here * here);
  }
}

std::size_t PlaceAmong(const std::vector<double>& starts_s, double time_s) {
  constexpr double kRounding = 1e-6;
  const auto after = std::upper_bound(starts_s.begin(), starts_s.end(), time_s + kRounding);
  return static_cast<std::size_t>(after - starts_s.begin());
}

// Recordings that left no segment do not count.
std::vector<std::size_t> CountedAnew(const std::vector<std::size_t>& places) {
  std::vector<std::size_t> counted(places.size(), 0);
  for (std::size_t i = 1; i < places.size(); ++i) {
    counted[i] = counted[i - 1] + (places[i] != places[i - 1] ? 1 : 0);
  }
  return counted;
}

}  // namespace

std::string_view Name(Preset preset) {
  switch (preset) {
    case Preset::kUnknown: return "UNKNOWN";
    case Preset::kPaper: return "PAPER";
    case Preset::kRobust: return "ROBUST";
  }
  return "";
}

PrepareOptions PrepareOptions::Paper() {
  PrepareOptions options;
  options.preset = Preset::kPaper;
  options.smoothing_half_width = 5;  // the paper does not say
  return options;
}

PrepareOptions PrepareOptions::Robust() {
  return {};
}

std::optional<Refusal> PrepareOptions::Validate() const {
  const std::string_view subject = "data preparation";
  const auto half_width = static_cast<double>(smoothing_half_width);
  const auto degree = static_cast<double>(smoothing_degree);
  if (preset == Preset::kUnknown) {
    return Refusal{std::string(subject), "preset is unknown", "set preset to paper or robust"};
  }
  if (sampling_period_s) {
    if (auto r = OutOfRange(subject, "sampling_period_s", *sampling_period_s, kShortestPeriodS,
                            kLongestPeriodS)) {
      return r;
    }
  }
  if (auto r = OutOfRange(subject, "smoothing_half_width", half_width, 2, 50)) return r;
  if (auto r = OutOfRange(subject, "smoothing_degree", degree, 1, std::min(5.0, 2 * half_width))) {
    return r;
  }
  if (auto r = OutOfRange(subject, "longest_gap_s", longest_gap_s, 0.1, 60.0)) return r;
  if (auto r = OutOfRange(subject, "shortest_segment_s", shortest_segment_s, 1.0, 600.0)) return r;
  if (auto r = OutOfRange(subject, "longest_slice_s", longest_slice_s, 2.0, 600.0)) return r;
  if (!longest_segment_s) return std::nullopt;
  return OutOfRange(subject, "longest_segment_s", *longest_segment_s, 10.0, 86400.0);
}

Result<PreparedDataset> Prepare(const Recording& recording, const Vehicle& vehicle,
                                const PrepareOptions& options) {
  if (auto refusal = options.Validate()) return tl::unexpected(*std::move(refusal));
  if (auto refusal = MissingChannel(recording)) return tl::unexpected(*std::move(refusal));
  RequireAscending(recording.gnss);
  RequireAscending(recording.heading);
  RequireAscending(recording.thrusters);

  PreparedDataset dataset;
  dataset.sampling_period_s = SamplingPeriod(recording.gnss, options);
  dataset.origin = {recording.gnss.front().latitude_deg, recording.gnss.front().longitude_deg};
  dataset.rejected = recording.rejected;
  dataset.options = options;
  dataset.sensors.antenna = vehicle.gnss_antenna;
  const NorthEastFrame frame(dataset.origin);
  double longest_found_s = 0.0;
  std::vector<std::size_t> places;  // of each segment among the recordings
  for (const Segment& segment : SegmentsOf(recording, options)) {
    longest_found_s = std::max(longest_found_s, segment.end_s - segment.start_s);
    const Grid grid = LayGrid(recording, segment, dataset.sampling_period_s);
    if (!LongEnough(grid, options)) continue;
    Signals signals = ReadSignals(recording, segment, vehicle, frame);
    Append(dataset, PrepareSegment(signals, grid, vehicle, options), options);
    places.push_back(PlaceAmong(recording.starts_s, segment.start_s));
    const SignalNoise noise(signals);
    PoolSensors(dataset, signals, noise);
    PoolNoise(dataset, NoiseInVelocity(noise, signals, grid, options));
    dataset.commands.push_back(std::move(signals.commands));
    dataset.signals.push_back(static_cast<RawSignals&&>(signals));
  }
  if (dataset.segments.empty()) {
    return tl::unexpected(NoSegment(options, dataset.sampling_period_s, longest_found_s));
  }
  dataset.recordings = CountedAnew(places);
  return dataset;
}

}  // namespace telltale
