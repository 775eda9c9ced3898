#include "telltale/core/estimation/prediction_error/covariance_filter.hpp"

#include <cmath>

#include "telltale/core/base/square.hpp"

namespace telltale {
namespace {

// A current changes by this much in a second, one sigma of its random walk.
constexpr double kCurrentWalk = 0.003;
constexpr double kHuberLimit = 4.0;

double VarianceOf(const ScalarReading& reading, const NoiseModel& noise) {
  if (!reading.is_fix) return Square(noise.heading_sigma_rad);
  return Square(noise.fix_sigma_m) + Square(reading.speed_m_s * noise.stamp_sigma_s);
}

}  // namespace

DecayOfStates DecayOver(const NoiseModel& noise, double step_s) {
  DecayOfStates decay = DecayOfStates::Ones();
  decay.head<3>().setConstant(std::exp(-step_s / noise.acceleration_time_constant_s));
  decay.segment<2>(kDriftState - kMovingStates)
      .setConstant(std::exp(-step_s / NoiseModel::kFixDriftTimeConstantS));
  return decay;
}

CovarianceFilter::CovarianceFilter(const NoiseModel& noise, double current_sigma_m_s,
                                   double misalignment_sigma_rad)
    : noise_(noise) {
  covariance_.setZero();
  covariance_.diagonal() << 4.0, 4.0, 0.1, 1.0, 0.25, 0.25, noise.acceleration_sigma.cwiseAbs2(),
      Eigen::Vector2d::Constant(Square(noise.fix_drift_sigma_m)),
      Eigen::Vector2d::Constant(Square(current_sigma_m_s)), Square(misalignment_sigma_rad);
}

void CovarianceFilter::Spread(const FilterTransition& transition) {
  const DecayOfStates& decay = transition.decay;
  const Eigen::Matrix<double, kFilterStates, kMovingStates> moved =
      transition.Moved(covariance_).transpose();
  // Rounding that is not symmetric would grow.
  const Eigen::Matrix<double, kMovingStates, kMovingStates> of_moving = transition.Moved(moved);
  covariance_.topLeftCorner<kMovingStates, kMovingStates>() =
      0.5 * (of_moving + of_moving.transpose());
  covariance_.bottomLeftCorner<kDecayingStates, kMovingStates>() =
      decay.asDiagonal() * moved.bottomRows<kDecayingStates>();
  covariance_.topRightCorner<kMovingStates, kDecayingStates>() =
      covariance_.bottomLeftCorner<kDecayingStates, kMovingStates>().transpose();
  covariance_.bottomRightCorner<kDecayingStates, kDecayingStates>().array() *=
      (decay * decay.transpose()).array();
  const DecayOfStates lost = 1.0 - decay.array().square();
  covariance_.diagonal().segment<3>(kDisturbanceState) +=
      lost.head<3>().cwiseProduct(noise_.acceleration_sigma.cwiseAbs2());
  covariance_.diagonal().segment<2>(kDriftState) +=
      Square(noise_.fix_drift_sigma_m) * lost.segment<2>(kDriftState - kMovingStates);
  covariance_.diagonal().segment<2>(kCurrentState).array() +=
      transition.step_s * Square(kCurrentWalk);
}

FilterGain CovarianceFilter::Take(const ScalarReading& reading) {
  const FilterState projected = ReadBy(reading.row, covariance_).transpose();
  FilterGain gain;
  gain.variance = reading.row.dot(projected) + VarianceOf(reading, noise_);
  const double ratio = Square(reading.innovation / kHuberLimit) / gain.variance;
  if (ratio > 1.0) gain.variance *= ratio;
  gain.gain = projected / gain.variance;
  // Symmetric to the last digit, as the product of gain and projection is not.
  const FilterState taken = projected / std::sqrt(gain.variance);
  covariance_ -= taken.lazyProduct(taken.transpose());
  return gain;
}

}  // namespace telltale
