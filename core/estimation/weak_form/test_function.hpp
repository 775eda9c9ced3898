#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/weak_form/weak_form_options.hpp"

namespace telltale {

/// The test function phi(t) = (1 - (t/T)^2)^6 and its slope on the sampling grid, multiplied by the
/// weights of the sum that replaces the integral. Both vanish with five derivatives at the ends, so
/// the error of the sum is negligible.
struct TestFunction {
  Eigen::VectorXd value;   ///< phi(t_i) h
  Eigen::VectorXd slope;   ///< phi'(t_i) h
  std::size_t stride = 1;  ///< rows between neighbouring supports

  std::size_t Rows() const { return static_cast<std::size_t>(value.size()); }

  static TestFunction On(double sampling_period_s, const WeakFormOptions& options);
};

/// The smoothing filter F of the dataset away from the ends of a segment: the weights with which
/// the mean velocities of the intervals about a row make its velocity.
Eigen::VectorXd FilterOnIntervals(const PreparedDataset& dataset);

/// phi convolved with F: the weights with which accelerations, by interval, enter a support. The
/// first is that of the interval half a filter before the first row of the support.
Eigen::VectorXd FilteredTestFunction(const Eigen::VectorXd& filter, const TestFunction& phi);

}  // namespace telltale
