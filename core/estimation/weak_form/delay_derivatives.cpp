#include "telltale/core/estimation/weak_form/delay_derivatives.hpp"

#include <algorithm>

namespace telltale {
namespace {

/// The slope of the velocities at a row, from its neighbours.
Eigen::Vector3d SlopeAt(std::span<const PredictedInstant> predicted, std::size_t row, double h) {
  const std::size_t before = row == 0 ? 0 : row - 1;
  const std::size_t after = std::min(row + 1, predicted.size() - 1);
  const Nu& from = predicted[before].nu;
  const Nu& to = predicted[after].nu;
  return Eigen::Vector3d(to.u - from.u, to.v - from.v, to.r - from.r) /
         (static_cast<double>(after - before) * h);
}

}  // namespace

DelayDerivatives::DelayDerivatives(const BodyDynamics& dynamics,
                                   std::span<const PredictedInstant> predicted,
                                   std::span<const ThrustRegressors> thrust,
                                   double sampling_period_s) {
  const auto rows = std::ssize(predicted);
  propelled_.resize(rows, 3);
  inertial_.resize(rows, 3);
  carried_.resize(rows, 3);
  for (Eigen::Index k = 0; k < rows; ++k) {
    const auto row = static_cast<std::size_t>(k);
    const Nu& nu = predicted[row].nu;
    const NuDot propelled = dynamics.Propelled(thrust[row]);
    const Eigen::Vector3d slope = SlopeAt(predicted, row, sampling_period_s);
    const Eigen::Vector3d inertial(slope[0] - nu.v * nu.r, slope[1] + nu.u * nu.r, 0.0);
    propelled_.row(k) << propelled.u, propelled.v, propelled.r;
    inertial_.row(k) = inertial;
    carried_.row(k) = dynamics.ByVelocity(nu) * inertial;
  }
}

Eigen::RowVector2d DelayDerivatives::Over(Eigen::Index first, std::size_t equation,
                                          const TestFunction& phi) const {
  const auto j = static_cast<Eigen::Index>(equation);
  const Eigen::Index rows = phi.slope.size();
  return {phi.slope.dot(propelled_.col(j).segment(first, rows)),
          phi.slope.dot(inertial_.col(j).segment(first, rows)) +
              phi.value.dot(carried_.col(j).segment(first, rows))};
}

}  // namespace telltale
