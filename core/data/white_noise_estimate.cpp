#include "telltale/core/data/white_noise_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <vector>
#include "telltale/core/base/median.hpp"

namespace telltale {
namespace {

constexpr std::size_t kPoints = 5;
constexpr double kMedianSizeOfStandardNormal = 0.6744897501960817;

// The divided difference of order four on times[0..4], its weights scaled to a norm of one. Time
// is counted in spans to keep the products of like size.
double ScaledDifference(const double* times_s, const double* values) {
  const double span_s = times_s[kPoints - 1] - times_s[0];
  double difference = 0.0;
  double squared_norm = 0.0;
  for (std::size_t i = 0; i < kPoints; ++i) {
    double product = 1.0;
    for (std::size_t j = 0; j < kPoints; ++j) {
      if (j != i) product *= (times_s[i] - times_s[j]) / span_s;
    }
    difference += values[i] / product;
    squared_norm += 1.0 / (product * product);
  }
  return difference / std::sqrt(squared_norm);
}

}  // namespace

double WhiteNoise(const TimeSeries& series) {
  if (series.values.size() < kPoints) return 0.0;
  std::vector<double> sizes(series.values.size() - kPoints + 1);
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    sizes[i] = std::abs(ScaledDifference(&series.times_s[i], &series.values[i]));
  }
  return Median(std::move(sizes)) / kMedianSizeOfStandardNormal;
}

}  // namespace telltale
