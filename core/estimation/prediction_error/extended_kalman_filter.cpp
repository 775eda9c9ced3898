#include "telltale/core/estimation/prediction_error/extended_kalman_filter.hpp"

#include <algorithm>
#include <cmath>

namespace telltale {
namespace {

using enum FossenParameter;

constexpr int kNorth = kNorthState;
constexpr int kEast = kNorthState + 1;

constexpr double kLongestStepS = 0.1;
constexpr double kLongestDecay = 1.5;   // of a step, in time constants of the damping
constexpr double kMostSubsteps = 40.0;  // of the longest step
constexpr double kShortestStepS = 1e-6;
// Headings closer than this to the one before bring nothing new and cost a step.
constexpr double kHeadingPeriodS = 0.095;
// Readings of one channel this long before and after those of the other count.
constexpr double kReadingsBeyondS = 0.5;

Eigen::Vector2d NorthEastOf(const LeverArm& arm, double psi_rad) {
  const double c = std::cos(psi_rad);
  const double s = std::sin(psi_rad);
  return {c * arm.forward_m - s * arm.starboard_m, s * arm.forward_m + c * arm.starboard_m};
}

Eigen::Vector2d VelocityOverGround(const FilterState& x) {
  const double c = std::cos(x[kHeadingState]);
  const double s = std::sin(x[kHeadingState]);
  const double u = x[kVelocityState];
  const double v = x[kVelocityState + 1];
  return {c * u - s * v + x[kCurrentState], s * u + c * v + x[kCurrentState + 1]};
}

// The regressors of thrust ahead, or in reverse, alone.
FossenDynamics::Thrusts Ahead(const FossenDynamics::Thrusts& thrust) {
  return {thrust[0], thrust[1], 0.0, 0.0};
}
FossenDynamics::Thrusts Astern(const FossenDynamics::Thrusts& thrust) {
  return {0.0, 0.0, thrust[2], thrust[3]};
}

double SpectralRadius(const Eigen::Matrix2d& a) {
  const double half_trace = 0.5 * a.trace();
  const double discriminant = half_trace * half_trace - a.determinant();
  return discriminant < 0.0 ? std::sqrt(a.determinant())
                            : std::abs(half_trace) + std::sqrt(discriminant);
}

}  // namespace

double HeadingOf(const FilterState& state) {
  return state[kHeadingState] + state[kMisalignmentState];
}

Eigen::Vector2d FixOf(const FilterState& state, const LeverArm& antenna) {
  return state.segment<2>(kNorthState) + NorthEastOf(antenna, state[kHeadingState]) +
         state.segment<2>(kDriftState);
}

std::vector<Reading> ReadingsOf(const RawSignals& signals, double fix_delay_s) {
  std::vector<Reading> readings;
  const auto& fixes = signals.north_m;
  const auto& headings = signals.psi_rad.times_s;
  if (fixes.times_s.empty() || headings.empty()) return readings;
  const double from_s = std::max(fixes.times_s.front(), headings.front()) - kReadingsBeyondS;
  const double until_s = std::min(fixes.times_s.back(), headings.back()) + kReadingsBeyondS;
  const auto is_within = [&](double t) { return from_s <= t && t <= until_s; };
  for (std::size_t i = 0; i < fixes.times_s.size(); ++i) {
    if (!is_within(fixes.times_s[i])) continue;
    readings.push_back(
        {fixes.times_s[i] - fix_delay_s, true, fixes.values[i], signals.east_m.values[i], 0.0});
  }
  double last_s = -1e300;
  for (std::size_t i = 0; i < signals.psi_rad.times_s.size(); ++i) {
    const double t = signals.psi_rad.times_s[i];
    if (!is_within(t) || t - last_s < kHeadingPeriodS) continue;
    last_s = t;
    readings.push_back({t, false, 0.0, 0.0, signals.psi_rad.values[i]});
  }
  std::ranges::stable_sort(readings, {}, &Reading::time_s);
  return readings;
}

std::optional<FilterState> StartOf(const std::vector<Reading>& readings) {
  const auto first_fix = std::ranges::find(readings, true, &Reading::is_fix);
  const auto first_heading = std::ranges::find(readings, false, &Reading::is_fix);
  if (first_fix == readings.end() || first_heading == readings.end()) return std::nullopt;
  FilterState start = FilterState::Zero();
  start[kHeadingState] = first_heading->psi_rad;
  start.segment<2>(kNorth) << first_fix->north_m, first_fix->east_m;
  return start;
}

ExtendedKalmanFilter::ExtendedKalmanFilter(const FilterSettings& settings,
                                           const HeldCommands& commands, double start_s,
                                           const FilterState& start)
    : settings_(settings),
      dynamics_(settings.parameters, settings.propeller_separation_m),
      thrust_(commands,
              {DeadZoneOf(settings.parameters), settings.parameters[At(kTimeConstant)],
               settings.parameters[At(kCommandDelay)]},
              start_s),
      now_s_(start_s),
      x_(start),
      covariance_(settings.noise, settings.current_sigma_m_s, settings.misalignment_sigma_rad) {
  slopes_.setZero();
  instruments_.setZero();
}

void ExtendedKalmanFilter::UseGains(const std::vector<FilterGain>* fixed,
                                    std::vector<FilterGain>* record) {
  fixed_gains_ = fixed;
  recorded_gains_ = record;
}

void ExtendedKalmanFilter::RecordSlopes(std::vector<InnovationSlope>* slopes,
                                        bool with_instruments) {
  recorded_slopes_ = slopes;
  with_instruments_ = with_instruments;
}

void ExtendedKalmanFilter::PredictTo(double time_s) {
  double ahead_s = time_s - now_s_;
  while (ahead_s >= kShortestStepS) {
    Step(ahead_s / std::ceil(ahead_s / LongestStepS() - 1e-9));
    ahead_s = time_s - now_s_;
  }
}

// The midpoint rule grows without bound where a step is longer than two time constants of the
// damping, which an ill-conditioned mass matrix makes short.
double ExtendedKalmanFilter::LongestStepS() const {
  const auto at = dynamics_.At(x_.segment<3>(kVelocityState), FossenDynamics::Thrusts::Zero(),
                               FossenDynamics::Thrusts::Zero());
  const double rate =
      std::max(std::abs(at.by_nu(0, 0)), SpectralRadius(at.by_nu.bottomRightCorner<2, 2>()));
  return std::max(kLongestStepS / kMostSubsteps, std::min(kLongestStepS, kLongestDecay / rate));
}

void ExtendedKalmanFilter::Take(const Reading& reading, std::vector<Innovation>& innovations) {
  PredictTo(reading.time_s);
  if (reading.is_fix) {
    TakeFix(reading.north_m, reading.east_m, innovations);
  } else {
    TakeHeading(reading.psi_rad, innovations);
  }
}

void ExtendedKalmanFilter::TakeHeading(double psi_rad, std::vector<Innovation>& innovations) {
  ScalarReading reading;
  reading.row[kHeadingState] = 1.0;
  reading.row[kMisalignmentState] = 1.0;
  reading.innovation = psi_rad - HeadingOf(x_);
  TakeScalar(reading, {}, innovations);
}

// North and east of a fix turned into along and across the track, where the noise of the stamp
// is the one's alone.
void ExtendedKalmanFilter::TakeFix(double north_m, double east_m,
                                   std::vector<Innovation>& innovations) {
  const Eigen::Vector2d velocity = VelocityOverGround(x_);
  const double speed = velocity.norm();
  const Eigen::Vector2d along =
      speed > 1e-3 ? Eigen::Vector2d(velocity / speed) : Eigen::Vector2d(1.0, 0.0);
  const Eigen::Vector2d across(-along[1], along[0]);
  for (const bool is_along : {true, false}) {
    const Eigen::Vector2d axis = fixed_gains_ != nullptr ? (*fixed_gains_)[next_gain_].axis
                                 : is_along              ? along
                                                         : across;
    const Eigen::Vector2d lever = NorthEastOf(settings_.antenna, x_[kHeadingState]);
    const Eigen::Vector2d lever_by_psi(-lever[1], lever[0]);
    const Eigen::Vector2d predicted =
        FixOf(x_, settings_.antenna) -
        (settings_.parameters[At(kFixDelay)] - settings_.nominal_fix_delay_s) * velocity;
    ScalarReading reading;
    reading.is_fix = true;
    reading.row.segment<2>(kNorth) = axis.transpose();
    reading.row.segment<2>(kDriftState) = axis.transpose();
    reading.row[kHeadingState] = axis.dot(lever_by_psi);
    reading.innovation = axis.dot(Eigen::Vector2d(north_m, east_m) - predicted);
    reading.speed_m_s = is_along ? speed : 0.0;
    // A longer delay predicts where the boat was before.
    ByFixDelay by{axis.dot(velocity)};
    if (with_instruments_) by.instrument = axis.dot(VelocityOverGround(Undisturbed()));
    TakeScalar(reading, by, innovations);
    if (recorded_gains_ != nullptr) recorded_gains_->back().axis = axis;
  }
}

// The boat of the instruments, on the headings of the filter.
FilterState ExtendedKalmanFilter::Undisturbed() const {
  FilterState x = x_;
  x.segment<3>(kVelocityState) = undisturbed_nu_;
  x.segment<3>(kDisturbanceState).setZero();
  return x;
}

ExtendedKalmanFilter::Rate ExtendedKalmanFilter::RateAt(const FilterState& x,
                                                        const ThrustStep& thrust) const {
  Rate rate;
  const double c = rate.cos_psi = std::cos(x[kHeadingState]);
  const double s = rate.sin_psi = std::sin(x[kHeadingState]);
  const double u = x[kVelocityState];
  const double v = x[kVelocityState + 1];
  rate.value[kNorth] = c * u - s * v + x[kCurrentState];
  rate.value[kEast] = s * u + c * v + x[kCurrentState + 1];
  rate.value[kHeadingState] = x[kVelocityState + 2];
  rate.dynamics = dynamics_.At(x.segment<3>(kVelocityState), thrust.mean[0], thrust.mean[1]);
  rate.value.tail<3>() = rate.dynamics.nu_dot + x.segment<3>(kDisturbanceState);
  return rate;
}

// d rate / d parameter, the rows of the velocities alone.
ExtendedKalmanFilter::ByParameters ExtendedKalmanFilter::ByParameter(
    const FilterState& x, const Rate& rate, const ThrustStep& thrust) const {
  const Eigen::Vector3d nu = x.segment<3>(kVelocityState);
  const double u = nu[0];
  ByParameters by;
  by.leftCols<kForceParameters>() =
      dynamics_.ByParameter(nu, rate.dynamics.nu_dot, thrust.mean[0], thrust.mean[1]);
  by.col(At(kForwardDeadBand)) =
      dynamics_.ByThrust(u, Ahead(thrust.by_dead_bands[0]), Ahead(thrust.by_dead_bands[1]));
  by.col(At(kReverseDeadBand)) =
      dynamics_.ByThrust(u, Astern(thrust.by_dead_bands[0]), Astern(thrust.by_dead_bands[1]));
  by.col(At(kTimeConstant)) =
      dynamics_.ByThrust(u, thrust.by_time_constant[0], thrust.by_time_constant[1]);
  by.col(At(kCommandDelay)) = dynamics_.ByThrust(u, thrust.by_delay[0], thrust.by_delay[1]);
  by.col(At(kFixDelay)).setZero();
  return by;
}

// What ways made in body axes within a step, a column each, change of the moving states: the way
// itself, and by damping the velocities.
template <int kWays>
Eigen::Matrix<double, kMovingStates, kWays> ExtendedKalmanFilter::ByWay(
    const Midpoint& step, const Eigen::Matrix<double, 3, kWays>& way) {
  const double c = step.second.cos_psi;
  const double s = step.second.sin_psi;
  Eigen::Matrix<double, kMovingStates, kWays> by;
  by.row(kNorth) = c * way.row(0) - s * way.row(1);
  by.row(kEast) = s * way.row(0) + c * way.row(1);
  by.row(kHeadingState) = way.row(2);
  by.template bottomRows<3>() = step.second.dynamics.by_nu.lazyProduct(way);
  return by;
}

// The way made in a step beyond that of the midpoint rule: thrust comes early or late in the
// step, and the acceleration changes with the velocity.
void ExtendedKalmanFilter::AddThirdOrder(const Midpoint& step, const ThrustStep& thrust, double h,
                                         FilterState& next) const {
  const Eigen::Matrix3d& by_nu = step.second.dynamics.by_nu;
  const double u = step.middle[kVelocityState];
  const Eigen::Vector3d way = dynamics_.ByThrust(u, thrust.early[0], thrust.early[1]) +
                              (h * h * h / 6.0) * (by_nu * step.second.value.tail<3>());
  next.head<kMovingStates>() += ByWay<1>(step, way);
}

// Moves the states that move, by the midpoint rule under the mean thrust.
ExtendedKalmanFilter::Midpoint ExtendedKalmanFilter::Advance(const ThrustStep& thrust, double h,
                                                             FilterState& x) const {
  Midpoint step;
  step.first = RateAt(x, thrust);
  step.middle = x;
  step.middle.head<kMovingStates>() += 0.5 * h * step.first.value;
  step.second = RateAt(step.middle, thrust);
  x.head<kMovingStates>() += h * step.second.value;
  AddThirdOrder(step, thrust, h, x);
  return step;
}

// How an acceleration that is held over the step moves the moving states, without what the turn of
// the axes and the curvature of the damping add.
ExtendedKalmanFilter::MovingByAcceleration ExtendedKalmanFilter::ByHeldAcceleration(
    const Midpoint& step, double h) {
  Eigen::Matrix3d way = (h * h * h / 6.0) * step.second.dynamics.by_nu;
  way.diagonal().array() += 0.5 * h * h;
  MovingByAcceleration by = ByWay<3>(step, way);
  by.bottomRows<3>().diagonal().array() += h;
  return by;
}

FilterTransition ExtendedKalmanFilter::TransitionOf(const Midpoint& step, double h,
                                                    const DecayOfStates& decay) {
  constexpr int kHeading = 0;  // of the movers
  constexpr int kVelocity = kVelocityState - kHeadingState;
  const double c = step.second.cos_psi;
  const double s = step.second.sin_psi;
  const double u = step.middle[kVelocityState];
  const double v = step.middle[kVelocityState + 1];
  const Eigen::Vector2d by_heading(-s * u - c * v, c * u - s * v);  // of the velocity over ground
  const MovingByAcceleration held = ByHeldAcceleration(step, h);
  FilterTransition transition;
  transition.step_s = h;
  transition.decay = decay;
  MotionByMovers& by = transition.by_movers;
  by.col(kHeading) << h * by_heading, 1.0, Eigen::Vector3d::Zero();
  auto by_velocity = by.middleCols<3>(kVelocity);
  by_velocity = held.lazyProduct(step.second.dynamics.by_nu);
  by_velocity.topLeftCorner<2, 2>() += h * (Eigen::Matrix2d() << c, -s, s, c).finished();
  by_velocity.col(2).head<2>() += (0.5 * h * h) * by_heading;
  by_velocity(kHeadingState, 2) += h;
  by_velocity.bottomRows<3>().diagonal().array() += 1.0;
  by.rightCols<3>() = held;
  return transition;
}

// A parameter changes the velocities as a disturbing acceleration does. As halfway through the step
// it does so on average, and nearly so where it counts by how early it does.
void ExtendedKalmanFilter::AdvanceSlopes(const Midpoint& step, const FilterTransition& transition,
                                         const ThrustStep& thrust, Slopes& slopes) const {
  slopes.topRows<kMovingStates>() = transition.Moved(slopes);
  slopes.topRows<kMovingStates>() += transition.by_movers.rightCols<3>().lazyProduct(
      ByParameter(step.middle, step.second, thrust));
  slopes.bottomRows<kDecayingStates>().array().colwise() *= transition.decay.array();
}

void ExtendedKalmanFilter::StepInstruments(const ThrustStep& thrust, const DecayOfStates& decay,
                                           double h) {
  const FilterState before = Undisturbed();
  FilterState undisturbed = before;
  const Midpoint step = Advance(thrust, h, undisturbed);
  AdvanceSlopes(step, TransitionOf(step, h, decay), thrust, instruments_);
  const double kept = std::exp(-h / settings_.instrument_time_constant_s);
  undisturbed_nu_ =
      kept * undisturbed.segment<3>(kVelocityState) + (1.0 - kept) * x_.segment<3>(kVelocityState);
  instruments_.middleRows<3>(kVelocityState) *= kept;
}

void ExtendedKalmanFilter::Step(double h) {
  const ThrustStep thrust = thrust_.Until(now_s_ + h);
  now_s_ += h;
  const DecayOfStates decay = DecayOver(settings_.noise, h);
  if (with_instruments_) StepInstruments(thrust, decay, h);
  const FilterState before = x_;
  const Midpoint step = Advance(thrust, h, x_);
  x_.tail<kDecayingStates>().array() *= decay.array();
  const bool spreads = fixed_gains_ == nullptr;
  if (!spreads && recorded_slopes_ == nullptr && !visit_) return;
  const FilterTransition transition = TransitionOf(step, h, decay);
  if (recorded_slopes_ != nullptr) AdvanceSlopes(step, transition, thrust, slopes_);
  if (visit_) visit_({transition.Whole()});
  if (spreads) covariance_.Spread(transition);
  if (variations_ == nullptr) return;
  for (NoiseVariation& variation : *variations_) variation.Step(transition, before);
}

FilterGain ExtendedKalmanFilter::GainOf(const ScalarReading& reading) {
  if (fixed_gains_ != nullptr) return (*fixed_gains_)[next_gain_++];
  FilterGain gain = covariance_.Take(reading);
  if (recorded_gains_ != nullptr) recorded_gains_->push_back(gain);
  return gain;
}

void ExtendedKalmanFilter::TakeScalar(const ScalarReading& reading, const ByFixDelay& by,
                                      std::vector<Innovation>& innovations) {
  const FilterGain gain = GainOf(reading);
  innovations.push_back({now_s_, reading.innovation, gain.variance});
  if (recorded_slopes_ != nullptr) {
    InnovationSlope& of = recorded_slopes_->emplace_back();
    of.slope = -ReadBy(reading.row, slopes_).transpose();
    of.slope[At(kFixDelay)] += by.slope;
    slopes_ += gain.gain.lazyProduct(of.slope.transpose());
    of.instrument = of.slope;
    if (with_instruments_) {
      of.instrument = -ReadBy(reading.row, instruments_).transpose();
      of.instrument[At(kFixDelay)] += by.instrument;
      instruments_ += gain.gain.lazyProduct(of.instrument.transpose());
    }
  }
  x_ += gain.gain * reading.innovation;
  if (visit_) visit_({std::nullopt, reading.row, gain.gain, reading.innovation / gain.variance});
  if (variations_ == nullptr) return;
  for (NoiseVariation& variation : *variations_) variation.Take(reading, gain, now_s_);
}

}  // namespace telltale
