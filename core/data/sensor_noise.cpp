#include "telltale/core/data/sensor_noise.hpp"

#include <cmath>

#include "telltale/core/data/savitzky_golay.hpp"
#include "telltale/core/data/white_noise_estimate.hpp"

namespace telltale {
namespace {

// The norm of the weights by which the values about a row give its slope, per row.
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

// The noise that remains of a signal once it is on the grid.
double NoiseOnGrid(double noise, const TimeSeries& series, const SamplingGrid& grid,
                   const PrepareOptions& options) {
  const bool averaged = options.preset == Preset::kRobust && IsAveraged(series, grid);
  return averaged ? noise / std::sqrt(SamplesPerRow(series, grid)) : noise;
}

double MeanPeriod(const TimeSeries& series) {
  const auto& times = series.times_s;
  return times.size() < 2 ? 0.0
                          : (times.back() - times.front()) / static_cast<double>(times.size() - 1);
}

double ShareOfLastSegment(const PreparedDataset& dataset) {
  return static_cast<double>(dataset.segments.back().size()) /
         static_cast<double>(dataset.rows.size());
}

}  // namespace

SignalNoise::SignalNoise(const SegmentSignals& signals)
    : north_m(WhiteNoise(signals.north_m)),
      east_m(WhiteNoise(signals.east_m)),
      psi_rad(WhiteNoise(signals.psi_rad)) {}

Nu NoiseInVelocity(const SignalNoise& noise, const SegmentSignals& signals,
                   const SamplingGrid& grid, const PrepareOptions& options) {
  const SavitzkyGolay filter(options.smoothing_half_width, options.smoothing_degree);
  const double gain = SlopeNorm(filter, options) / grid.period_s;
  const double position_m = std::hypot(NoiseOnGrid(noise.north_m, signals.north_m, grid, options),
                                       NoiseOnGrid(noise.east_m, signals.east_m, grid, options)) /
                            std::sqrt(2.0);
  const double psi_rad = NoiseOnGrid(noise.psi_rad, signals.psi_rad, grid, options);
  return {gain * position_m, gain * position_m, gain * psi_rad};
}

void PoolSensors(PreparedDataset& dataset, const SegmentSignals& signals,
                 const SignalNoise& noise) {
  const double share = ShareOfLastSegment(dataset);
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

void PoolNoise(PreparedDataset& dataset, const Nu& of_segment) {
  const double share = ShareOfLastSegment(dataset);
  for (const auto velocity : {&Nu::u, &Nu::v, &Nu::r}) {
    const double so_far = dataset.nu_noise.*velocity;
    const double here = of_segment.*velocity;
    dataset.nu_noise.*velocity = std::sqrt((1.0 - share) * so_far * so_far + share * here * here);
  }
}

}  // namespace telltale
