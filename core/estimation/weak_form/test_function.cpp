#include "telltale/core/estimation/weak_form/test_function.hpp"

#include <algorithm>
#include <cmath>

#include "telltale/core/data/savitzky_golay.hpp"

namespace telltale {

TestFunction TestFunction::On(double sampling_period_s, const WeakFormOptions& options) {
  constexpr double kLeastRows = 5.0;
  const double h = sampling_period_s;
  const double half_rows = std::max(kLeastRows, std::round(options.half_support_s / h));
  const auto rows = static_cast<Eigen::Index>(2.0 * half_rows) - 1;  // it is zero at both ends
  const Eigen::Index centre = rows / 2;
  const double T = half_rows * h;
  TestFunction phi{Eigen::VectorXd(rows), Eigen::VectorXd(rows), 1};
  for (Eigen::Index i = 0; i < rows; ++i) {
    const double s = static_cast<double>(i - centre) * h / T;
    const double below = 1.0 - s * s;
    phi.value[i] = h * std::pow(below, 6);
    phi.slope[i] = h * -12.0 * s / T * std::pow(below, 5);
  }
  phi.stride = static_cast<std::size_t>(std::max(1.0, std::round(options.spacing_s / h)));
  return phi;
}

Eigen::VectorXd FilterOnIntervals(const PreparedDataset& dataset) {
  const std::size_t centre = dataset.options.smoothing_half_width;
  const SavitzkyGolay filter(centre, dataset.options.smoothing_degree);
  Eigen::VectorXd weights(static_cast<Eigen::Index>(filter.WindowLength()) - 1);
  for (Eigen::Index i = 0; i < weights.size(); ++i) {
    weights[i] = filter.IncrementWeight(centre, static_cast<std::size_t>(i));
  }
  return weights;
}

Eigen::VectorXd FilteredTestFunction(const Eigen::VectorXd& filter, const TestFunction& phi) {
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(phi.value.size() + filter.size() - 1);
  for (Eigen::Index i = 0; i < phi.value.size(); ++i) {
    weights.segment(i, filter.size()) += phi.value[i] * filter;
  }
  return weights;
}

}  // namespace telltale
