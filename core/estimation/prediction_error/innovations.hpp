#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/prediction_error/thrust_lag.hpp"
#include "telltale/core/vessel/fossen_model.hpp"

namespace telltale {

/// Process and sensor noise. All > 0.
/// Model: accelerations of the boat and the error of the fixes are first-order Gauss-Markov
/// processes beside white sensor noise; the stamp of a fix is off by white noise.
struct NoiseModel {
  Eigen::Vector3d acceleration_sigma{0.1, 0.1, 0.1};  ///< m/s^2, m/s^2, rad/s^2, stationary
  double acceleration_time_constant_s = 2.0;
  double fix_drift_sigma_m = 0.1;
  double fix_sigma_m = 0.05;
  double heading_sigma_rad = 0.01;
  double stamp_sigma_s = 0.02;

  static constexpr double kFixDriftTimeConstantS = 20.0;
};

/// One innovation, a scalar: the reading less its prediction from all readings before it.
struct Innovation {
  double time_s = 0.0;
  double value = 0.0;
  double variance = 0.0;
  FossenVector slope;  ///< d value / d parameters at fixed gains; unset unless asked for
  /// The slope that the commands alone give: that of a boat without disturbance on the same
  /// headings. Equal to the slope unless asked for.
  FossenVector instrument;
};

struct FilterSettings {
  FossenVector parameters;
  double current_sigma_m_s = 0.3;
  double misalignment_sigma_rad = 0.087;
  NoiseModel noise;
  double propeller_separation_m = 0.0;
  LeverArm antenna;
  bool with_slopes = false;
  bool with_instruments = false;  ///< beside the slopes
  /// The delay at which the fixes are put in order; the difference to that of the parameters moves
  /// what is predicted for them.
  double nominal_fix_delay_s = 0.0;
};

/// States of the filter: position north, east and heading of the body origin; u, v, r through the
/// water; the disturbing accelerations; the drift of the fixes north and east; the current north
/// and east; what the compass reads too much.
inline constexpr int kFilterStates = 14;
inline constexpr int kNorthState = 0;
inline constexpr int kHeadingState = 2;
inline constexpr int kVelocityState = 3;
inline constexpr int kDisturbanceState = 6;
inline constexpr int kDriftState = 9;
inline constexpr int kCurrentState = 11;
inline constexpr int kMisalignmentState = 13;
using FilterState = Eigen::Matrix<double, kFilterStates, 1>;
using FilterCovariance = Eigen::Matrix<double, kFilterStates, kFilterStates>;

/// What a heading, and a fix north and east, read of a state where nothing is late.
/// Model: docs/concepts/physical-model.md (107), (108).
double HeadingOf(const FilterState& state);
Eigen::Vector2d FixOf(const FilterState& state, const LeverArm& antenna);

/// How one scalar reading moves the state, and the variance of its innovation.
struct FilterGain {
  FilterState gain;
  double variance = 0.0;
  Eigen::Vector2d axis = Eigen::Vector2d::Zero();  ///< of a fix: the direction that is read
};

/// The innovations of an extended Kalman filter along one segment: fixes north and east, headings.
/// Slopes leave out terms of third order in the step.
/// A reading further than four standard deviations off counts with the variance at which it is
/// four (Huber's weight).
/// Model: docs/concepts/physical-model.md (106)..(109).
std::vector<Innovation> InnovationsOf(const RawSignals& signals, const HeldCommands& commands,
                                      const FilterSettings& settings,
                                      std::vector<FilterGain>* gains = nullptr);

/// The same with the gains of another run over the same readings at the same nominal delay.
std::vector<Innovation> InnovationsWith(const std::vector<FilterGain>& gains,
                                        const RawSignals& signals, const HeldCommands& commands,
                                        const FilterSettings& settings);

/// What the filter says at given times of the readings before them.
std::vector<FilterState> FilteredStates(const RawSignals& signals, const HeldCommands& commands,
                                        const FilterSettings& settings,
                                        const std::vector<double>& times_s);

/// The states at given times, ahead of `start_s`, without any reading.
std::vector<FilterState> PredictedStates(const FilterState& start, double start_s,
                                         const HeldCommands& commands,
                                         const FilterSettings& settings,
                                         const std::vector<double>& times_s);

}  // namespace telltale
