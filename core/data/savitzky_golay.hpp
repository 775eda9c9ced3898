#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace telltale {

/// Savitzky-Golay filter: the value and slope of a least-squares polynomial over a smoothing window
/// of 2 half_width + 1 equally spaced values. The ends of a series take the polynomial of the first
/// or last full window. Weights are made once.
/// The filter is exact on polynomials up to `degree`. Slopes are per sample; divide by the period
/// for rates.
/// Source: Savitzky and Golay, Analytical Chemistry 36 (1964); Gorry, Analytical Chemistry 62
/// (1990) for the ends.
class SavitzkyGolay {
 public:
  /// Requires: half_width >= 1, degree < 2 half_width + 1.
  SavitzkyGolay(std::size_t half_width, std::size_t degree);

  std::size_t WindowLength() const { return static_cast<std::size_t>(value_.cols()); }

  /// First row of the window that filters row `row` of a series of `length` rows.
  std::size_t WindowStart(std::size_t row, std::size_t length) const;

  /// Weights of the value and of the slope at `position` in the window, [0, WindowLength()).
  Eigen::RowVectorXd ValueWeights(std::size_t position) const {
    return value_.row(Index(position));
  }
  Eigen::RowVectorXd SlopeWeights(std::size_t position) const {
    return slope_.row(Index(position));
  }

  /// The slope as a sum over increments between neighbours: the weight of the increment from
  /// `interval` to interval + 1, in [0, WindowLength() - 1). The weights sum to one. A filtered
  /// velocity is this weighted mean of interval velocities, so its cause is filtered alike.
  double IncrementWeight(std::size_t position, std::size_t interval) const {
    return increment_(Index(position), Index(interval));
  }

  /// Filtered values; the series must be at least WindowLength() long.
  std::vector<double> Smooth(std::span<const double> series) const;

  /// Filtered slope at every row, per sample.
  std::vector<double> Slope(std::span<const double> series) const;

  /// Filtered slope at every row of a series known by its increments; one row more than increments.
  std::vector<double> SlopeOfIncrements(std::span<const double> increments) const;

 private:
  Eigen::Index Index(std::size_t position) const { return static_cast<Eigen::Index>(position); }
  std::vector<double> Apply(const Eigen::MatrixXd& weights, std::span<const double> series,
                            std::size_t rows) const;

  std::size_t half_width_;
  Eigen::MatrixXd value_;      // one row of weights per position in the window
  Eigen::MatrixXd slope_;      // likewise
  Eigen::MatrixXd increment_;  // likewise, one column fewer
};

}  // namespace telltale
