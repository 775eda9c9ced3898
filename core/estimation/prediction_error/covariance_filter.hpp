#pragma once

#include <Eigen/Core>

#include "telltale/core/estimation/prediction_error/filter_transition.hpp"
#include "telltale/core/estimation/prediction_error/noise_model.hpp"

namespace telltale {

using FilterRow = Eigen::Matrix<double, 1, kFilterStates>;

/// One number that is read of the state: a heading, or a fix along one axis.
struct ScalarReading {
  FilterRow row = FilterRow::Zero();  ///< of position, heading, drift and misalignment alone
  double innovation = 0.0;            ///< the reading less its prediction
  bool is_fix = false;
  double speed_m_s = 0.0;  ///< along the axis of a fix, where an error of its stamp moves it
};

/// How one scalar reading moves the state, and the variance of its innovation.
struct FilterGain {
  FilterState gain;
  double variance = 0.0;
  Eigen::Vector2d axis = Eigen::Vector2d::Zero();  ///< of a fix: the direction that is read
};

/// What a scalar reading reads of each column.
template <int kColumns>
Eigen::Matrix<double, 1, kColumns> ReadBy(const FilterRow& row,
                                          const Eigen::Matrix<double, kFilterStates, kColumns>& m) {
  return row.head<3>().lazyProduct(m.template topRows<3>()) +
         row.segment<2>(kDriftState).lazyProduct(m.template middleRows<2>(kDriftState)) +
         row[kMisalignmentState] * m.row(kMisalignmentState);
}

/// What is left of the states that decay after a step; exact.
DecayOfStates DecayOver(const NoiseModel& noise, double step_s);

/// The covariance of a filter's state under one noise, and the gains that follow from it.
/// A reading further than four standard deviations off counts with the variance at which it is four
/// (Huber's weight).
class CovarianceFilter {
 public:
  CovarianceFilter(const NoiseModel& noise, double current_sigma_m_s,
                   double misalignment_sigma_rad);

  void Spread(const FilterTransition& transition);
  FilterGain Take(const ScalarReading& reading);

  const NoiseModel& Noise() const { return noise_; }
  const FilterCovariance& Covariance() const { return covariance_; }

 private:
  NoiseModel noise_;
  FilterCovariance covariance_;
};

}  // namespace telltale
