#include "telltale/core/estimation/weak_form/smoothing_width.hpp"

#include <algorithm>
#include <cmath>

#include "telltale/core/data/savitzky_golay.hpp"

namespace telltale {
namespace {

constexpr double kLeastS = 0.8;
constexpr double kLeastOfLongS = 1.6;
constexpr double kLongS = 900.0;  // a recording from here on is long
constexpr std::size_t kMostRows = 16;
constexpr double kMostNoise = 0.5;  // of the standard deviation of sway

double SwayDeviation(const PreparedDataset& dataset) {
  double sum = 0.0;
  double squares = 0.0;
  for (const PreparedRow& row : dataset.rows) {
    sum += row.nu.v;
    squares += row.nu.v * row.nu.v;
  }
  const auto n = static_cast<double>(dataset.rows.size());
  return std::sqrt(std::max(0.0, squares / n - (sum / n) * (sum / n)));
}

}  // namespace

std::size_t SmoothingFor(const PreparedDataset& preview) {
  const double deviation = SwayDeviation(preview);
  const auto n = static_cast<double>(preview.rows.size());
  const double h = preview.sampling_period_s;
  const double least_s = n * h < kLongS ? kLeastS : kLeastOfLongS;
  auto half_width = static_cast<std::size_t>(std::max(2.0, std::round(least_s / h)));
  const auto noise = [&](std::size_t width) {
    const SavitzkyGolay filter(width, preview.options.smoothing_degree);
    return preview.sensors.position_noise_m / h * filter.SlopeWeights(width).norm();
  };
  while (half_width < kMostRows && noise(half_width) > kMostNoise * deviation) ++half_width;
  return half_width;
}

}  // namespace telltale
