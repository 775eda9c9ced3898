#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/prediction_error/covariance_filter.hpp"
#include "telltale/core/estimation/prediction_error/filter_transition.hpp"
#include "telltale/core/estimation/prediction_error/innovation.hpp"
#include "telltale/core/estimation/prediction_error/noise_model.hpp"
#include "telltale/core/estimation/prediction_error/noise_variation.hpp"
#include "telltale/core/estimation/prediction_error/thrust_lag.hpp"
#include "telltale/core/vessel/fossen_model.hpp"

namespace telltale {

struct FilterSettings {
  FossenVector parameters;
  double current_sigma_m_s = 0.3;
  double misalignment_sigma_rad = 0.087;
  NoiseModel noise;
  double propeller_separation_m = 0.0;
  LeverArm antenna;
  /// The delay at which the fixes are put in order; the difference to that of the parameters moves
  /// what is predicted for them.
  double nominal_fix_delay_s = 0.0;
  /// The time constant with which the boat of the instruments follows the velocities of the filter.
  /// Infinite: the commands alone drive it.
  double instrument_time_constant_s = std::numeric_limits<double>::infinity();
};

/// What a heading, and a fix north and east, read of a state where nothing is late.
/// Model: docs/concepts/physical-model.md (107), (108).
double HeadingOf(const FilterState& state);
Eigen::Vector2d FixOf(const FilterState& state, const LeverArm& antenna);

/// A fix or a heading, at the time at which the boat had what it reads.
struct Reading {
  double time_s = 0.0;
  bool is_fix = false;
  double north_m = 0.0;
  double east_m = 0.0;
  double psi_rad = 0.0;
};

/// The readings in the order of their times, where both channels are read: one may go on where the
/// other has a gap.
std::vector<Reading> ReadingsOf(const RawSignals& signals, double fix_delay_s);

/// At the first fix and the first heading, at rest. Nothing where one of them is missing.
std::optional<FilterState> StartOf(const std::vector<Reading>& readings);

/// What moves the filter, as a smoother needs it on its way back: a step, or a scalar reading.
struct FilterMove {
  std::optional<FilterCovariance> transition;  ///< of a step
  FilterRow row = FilterRow::Zero();
  FilterState gain = FilterState::Zero();
  double weighted_innovation = 0.0;  ///< over its variance
};

/// An extended Kalman filter of a boat of the physical form, with the slopes of what it predicts.
/// Model: docs/concepts/physical-model.md (101)..(109). Transitions leave out terms of fourth order
/// in the step, slopes with the parameters part of the third.
class ExtendedKalmanFilter {
 public:
  /// Requires: `settings` outlives the filter.
  ExtendedKalmanFilter(const FilterSettings& settings, const HeldCommands& commands, double start_s,
                       const FilterState& start);

  /// Takes the gains of another run from now on, or records its own.
  void UseGains(const std::vector<FilterGain>* fixed, std::vector<FilterGain>* record);

  /// Appends the slope of each innovation from now on, with its instrument if so asked.
  void RecordSlopes(std::vector<InnovationSlope>* slopes, bool with_instruments);

  /// Takes filters of other noises along from now on. Requires: no gains of another run.
  void RunBeside(std::vector<NoiseVariation>* variations) { variations_ = variations; }

  /// Calls visit(move) for every step and every scalar reading from now on.
  void VisitMoves(std::function<void(const FilterMove&)> visit) { visit_ = std::move(visit); }

  void PredictTo(double time_s);

  /// Predicts to the time of the reading and takes it. Appends its innovations.
  void Take(const Reading& reading, std::vector<Innovation>& innovations);

  const FilterState& Mean() const { return x_; }
  const FilterCovariance& Covariance() const { return covariance_.Covariance(); }

 private:
  using Moving = Eigen::Matrix<double, kMovingStates, 1>;
  using MovingByAcceleration = Eigen::Matrix<double, kMovingStates, 3>;
  using ByParameters = Eigen::Matrix<double, 3, static_cast<int>(kFossenParameters)>;
  using Slopes = Eigen::Matrix<double, kFilterStates, static_cast<int>(kFossenParameters)>;

  // The rate of the states that move, with what its slopes are made of.
  struct Rate {
    double cos_psi = 1.0;
    double sin_psi = 0.0;
    FossenDynamics::Evaluation dynamics;
    Moving value;
  };

  // A step of the midpoint rule.
  struct Midpoint {
    Rate first;
    FilterState middle;
    Rate second;
  };

  // What a reading changes with the delay of the fixes, the rest being the same.
  struct ByFixDelay {
    double slope = 0.0;
    double instrument = 0.0;
  };

  void TakeHeading(double psi_rad, std::vector<Innovation>& innovations);
  void TakeFix(double north_m, double east_m, std::vector<Innovation>& innovations);
  void TakeScalar(const ScalarReading& reading, const ByFixDelay& by,
                  std::vector<Innovation>& innovations);
  FilterGain GainOf(const ScalarReading& reading);
  FilterState Undisturbed() const;
  Rate RateAt(const FilterState& x, const ThrustStep& thrust) const;
  ByParameters ByParameter(const FilterState& x, const Rate& rate, const ThrustStep& thrust) const;
  template <int kWays>
  static Eigen::Matrix<double, kMovingStates, kWays> ByWay(
      const Midpoint& step, const Eigen::Matrix<double, 3, kWays>& way);
  void AddThirdOrder(const Midpoint& step, const ThrustStep& thrust, double h,
                     FilterState& next) const;
  Midpoint Advance(const ThrustStep& thrust, double h, FilterState& x) const;
  static MovingByAcceleration ByHeldAcceleration(const Midpoint& step, double h);
  static FilterTransition TransitionOf(const Midpoint& step, double h, const DecayOfStates& decay);
  void AdvanceSlopes(const Midpoint& step, const FilterTransition& transition,
                     const ThrustStep& thrust, Slopes& slopes) const;
  double LongestStepS() const;
  void StepInstruments(const ThrustStep& thrust, const DecayOfStates& decay, double h);
  void Step(double h);

  std::function<void(const FilterMove&)> visit_;
  const std::vector<FilterGain>* fixed_gains_ = nullptr;
  std::vector<FilterGain>* recorded_gains_ = nullptr;
  std::vector<InnovationSlope>* recorded_slopes_ = nullptr;
  bool with_instruments_ = false;
  std::vector<NoiseVariation>* variations_ = nullptr;
  std::size_t next_gain_ = 0;
  const FilterSettings& settings_;
  FossenDynamics dynamics_;
  ThrustLag thrust_;
  double now_s_;
  FilterState x_;
  CovarianceFilter covariance_;
  Slopes slopes_;
  Slopes instruments_;
  Eigen::Vector3d undisturbed_nu_ = Eigen::Vector3d::Zero();
};

}  // namespace telltale
