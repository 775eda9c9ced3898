#include "telltale/core/effects/augmented_boat.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include <Eigen/Geometry>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/simulation/simulator.hpp"
#include "telltale/core/vessel/body_regressors.hpp"
#include "telltale/core/vessel/runge_kutta.hpp"

namespace telltale {
namespace {

// Thrusters have forgotten what they were told so many time constants ago.
constexpr double kStartUpTimeConstants = 6.0;
// Runge-Kutta's error over it, a hundred-thousandth of the change of a yaw rate that decays in a
// third of a second, is far below what sensors see.
constexpr double kMaximumStepS = 0.2;
constexpr double kShortestStepS = 1e-3;  // of a stiff boat
constexpr double kRounding = 1e-9;

NuDot Times(const NuDot& a, double share) {
  return {share * a.u, share * a.v, share * a.r};
}

NuDot Plus(const NuDot& a, const NuDot& b, double share = 1.0) {
  return {a.u + share * b.u, a.v + share * b.v, a.r + share * b.r};
}

std::span<double> TermsOf(telltale::Equation equation, HullTerms& terms) {
  if (equation == telltale::Equation::kSurge) return terms.surge;
  return equation == telltale::Equation::kSway ? std::span<double>(terms.sway) : terms.yaw;
}

template <std::size_t kCount>
std::array<double, kCount> Times(const std::array<double, kCount>& a,
                                 const std::array<double, kCount>& b) {
  std::array<double, kCount> product{};
  for (std::size_t i = 0; i < kCount; ++i) product[i] = a[i] * b[i];
  return product;
}

HullTerms Times(const HullTerms& coefficients, const BodyRow& row) {
  return {Times(coefficients.surge, row.surge), Times(coefficients.sway, row.turning),
          Times(coefficients.yaw, row.turning)};
}

Drive AddScaled(const Drive& sum, const Drive& more, double weight) {
  return {
      {Plus(sum.thrust[0], more.thrust[0], weight), Plus(sum.thrust[1], more.thrust[1], weight)},
      sum.load + weight * more.load};
}

/// The first-order lag of both sides' thrust under drives that are steady through each step.
class LaggedThrust {
 public:
  LaggedThrust(double lag_s, double step_s, const Drive& first)
      : remaining_(std::exp(-step_s / lag_s)),
        mean_((1.0 - remaining_) * lag_s / step_s),
        now_(first) {}

  /// The mean through a step that tends to `steady`.
  Drive Follow(const Drive& steady) {
    const Drive behind = AddScaled(now_, steady, -1.0);
    Drive mean = AddScaled(steady, behind, mean_);
    mean.load = steady.load;
    now_ = AddScaled(steady, behind, remaining_);
    return mean;
  }

 private:
  double remaining_;
  double mean_;
  Drive now_;
};

// T = n abs(n) and back, each component of a side's thrust in units of its own.
double SpeedFor(double thrust) {
  return std::copysign(std::sqrt(std::abs(thrust)), thrust);
}

double ThrustAt(double speed) {
  return speed * std::abs(speed);
}

// Gauss and Legendre's two nodes, exact for cubics of time.
constexpr std::array kNodes = {0.5 - 0.5 / std::numbers::sqrt3, 0.5 + 0.5 / std::numbers::sqrt3};

/// Two shafts whose speed follows what they are told by first orders, one after the other.
class ShaftLagChain {
 public:
  ShaftLagChain(std::span<const double> lags_s, const SideThrust& first) {
    for (const double lag_s : lags_s) stages_.push_back({lag_s, first});
  }

  /// What they give on average while they are told to give the same for so long.
  SideThrust Follow(const SideThrust& commanded, double time_s) {
    if (stages_.empty()) return commanded;
    SideThrust mean;
    for (const double node : kNodes) {
      SideThrust given = commanded;
      for (const Stage& stage : stages_) given = stage.After(node * time_s, given);
      for (std::size_t side = 0; side < 2; ++side) mean[side] = Plus(mean[side], given[side], 0.5);
    }
    SideThrust given = commanded;
    for (Stage& stage : stages_) given = stage.now = stage.After(time_s, given);
    return mean;
  }

 private:
  struct Stage {
    double lag_s;
    SideThrust now;

    SideThrust After(double time_s, const SideThrust& commanded) const {
      const double remaining = std::exp(-time_s / lag_s);
      const auto between = [&](double from, double to) {
        const double end = SpeedFor(to);
        return ThrustAt(end + remaining * (SpeedFor(from) - end));
      };
      SideThrust thrust;
      for (std::size_t side = 0; side < 2; ++side) {
        thrust[side] = {between(now[side].u, commanded[side].u),
                        between(now[side].v, commanded[side].v),
                        between(now[side].r, commanded[side].r)};
      }
      return thrust;
    }
  };

  std::vector<Stage> stages_;
};

/// Two outputs that go towards their commands at a limited rate.
class SlewedOutputs {
 public:
  SlewedOutputs(double travel_s, const PropellerCommand& first)
      : travel_s_(travel_s), now_(first) {}

  /// Their mean while they are told the same for so long.
  PropellerCommand Follow(const PropellerCommand& command, double time_s) {
    if (travel_s_ == 0.0) return command;
    return {Mean(now_.port, command.port, time_s), Mean(now_.starboard, command.starboard, time_s)};
  }

 private:
  double Mean(double& now, double command, double time_s) const {
    const double travel = std::min(std::abs(command - now), time_s / travel_s_);
    const double start = now;
    now += std::copysign(travel, command - start);
    const double moving = travel * travel_s_ / time_s;  // share of the time
    return moving * 0.5 * (start + now) + (1.0 - moving) * now;
  }

  double travel_s_;
  PropellerCommand now_;
};

double SquaredDistance(const NuDot& a, const NuDot& b) {
  const NuDot between = Plus(a, b, -1.0);
  return between.u * between.u + between.v * between.v + between.r * between.r;
}

/// Whether the largest eigenvalue of the damping, times the step, is beyond two; near 2.8 a
/// Runge-Kutta step of order four grows without bound. The second and the third slope of a step
/// differ by it times half of what the first and the second do. Source: Hairer and Wanner, Solving
/// Ordinary Differential Equations II, IV.2, "Stiffness detection".
bool IsStiff(const NuDot& k1, const NuDot& k2, const NuDot& k3) {
  constexpr double kSteady = 1e-9;  // m/s^2, rad/s^2
  const double before = SquaredDistance(k2, k1);
  return before > kSteady * kSteady && !(SquaredDistance(k3, k2) <= before);
}

}  // namespace

std::size_t StepsPerRow(const VesselModel& model, double sampling_period_s) {
  if (model.discretisation == Discretisation::kForwardEuler) return 1;
  return static_cast<std::size_t>(std::ceil(sampling_period_s / kMaximumStepS - kRounding));
}

AugmentedBoat::AugmentedBoat(AugmentedModel model, const RecordingFrame& frame,
                             const HullParticulars& hull)
    : model_(std::move(model)), frame_(frame), hull_scale_(hull) {
  Require(frame.span_s > 0.0, "a span to simulate");
  for (const telltale::Equation equation : kEquations) {
    const std::size_t j = IndexOf(equation);
    const Eigen::VectorXd& theta = model_.model.theta[j];
    const std::size_t body = BodyRegressors(equation);
    for (std::size_t i = 0; i < static_cast<std::size_t>(theta.size()); ++i) {
      double& own = i < body ? TermsOf(equation, hull_)[i] : thrust_[j][i - body];
      own = theta[static_cast<Eigen::Index>(i)];
    }
  }
  for (const auto& [effect, values] : model_.effects) {
    Require(values.size() == effect->Parameters().size(), "one value per parameter");
    hooked_[static_cast<std::size_t>(effect->Facts().hook)].push_back({effect, values});
    if (const double lag_s = effect->ShaftLagS(values); lag_s > 0.0) {
      shaft_lags_s_.push_back(lag_s);
    }
    delay_s_ += effect->CommandDelayS(values);
    output_travel_s_ += effect->OutputTravelS(values);
    latency_s_ += effect->LatencyS(values);
    const LeverArm shift = effect->AntennaShift(values);
    antenna_shift_.forward_m += shift.forward_m;
    antenna_shift_.starboard_m += shift.starboard_m;
    current_ += effect->Current(values);
    current_gradient_ += effect->CurrentGradient(values);
  }
}

SideThrust AugmentedBoat::SteadyThrust(const PropellerCommand& delta) const {
  PropellerCommand altered = delta;
  for (const auto& [effect, values] : Hooked(Hook::kCommand)) {
    altered = {effect->Command(values, Side::kPort, altered.port),
               effect->Command(values, Side::kStarboard, altered.starboard)};
  }
  const auto accelerations = [&](const ThrustRegressors& thrust) {
    std::array<double, 3> sum{};
    for (std::size_t i = 0; i < 4; ++i) {
      sum[0] += thrust_[0][i] * thrust.surge[i];
      sum[1] += thrust_[1][i] * thrust.turning[i];
      sum[2] += thrust_[2][i] * thrust.turning[i];
    }
    return NuDot{sum[0], sum[1], sum[2]};
  };
  const NuDot port = accelerations(model_.model.SteadyThrust({altered.port, 0.0}));
  return {port, Plus(accelerations(model_.model.SteadyThrust(altered)), port, -1.0)};
}

std::vector<Drive> AugmentedBoat::DrivesAlong(const HeldCommands& commands, double from_s,
                                              double step_s, std::size_t steps) const {
  const double thrust_lag_s = model_.model.thruster_time_constant_s.value_or(0.0);
  const double lags_s = std::accumulate(shaft_lags_s_.begin(), shaft_lags_s_.end(), thrust_lag_s);
  const double memory_s = kStartUpTimeConstants * lags_s + 2.0 * output_travel_s_;
  const auto before = static_cast<std::size_t>(std::ceil(memory_s / step_s));
  const double first_s = from_s - delay_s_ - static_cast<double>(before) * step_s;
  SlewedOutputs outputs(output_travel_s_, commands.At(first_s));
  ShaftLagChain shafts(shaft_lags_s_, SteadyThrust(commands.At(first_s)));
  const auto drive_of_step = [&](std::size_t k) {
    const double start_s = first_s + static_cast<double>(k) * step_s;
    Drive mean;
    commands.ForEachPiece(
        start_s, start_s + step_s, [&](const PropellerCommand& command, double begin, double end) {
          const PropellerCommand delta = outputs.Follow(command, end - begin);
          const double load = 0.5 * (delta.port * delta.port + delta.starboard * delta.starboard);
          const SideThrust thrust = shafts.Follow(SteadyThrust(delta), end - begin);
          mean = AddScaled(mean, {thrust, load}, (end - begin) / step_s);
        });
    return mean;
  };
  std::optional<LaggedThrust> lagged;
  std::vector<Drive> drives;
  drives.reserve(steps);
  for (std::size_t k = 0; k < before + steps; ++k) {
    Drive drive = drive_of_step(k);
    if (thrust_lag_s > 0.0) {
      if (!lagged) lagged.emplace(thrust_lag_s, step_s, drive);
      drive = lagged->Follow(drive);
    }
    if (k >= before) drives.push_back(drive);
  }
  return drives;
}

bool AugmentedBoat::IsDrivenLike(const AugmentedBoat& other) const {
  const VesselModel& own = model_.model;
  const VesselModel& its = other.model_.model;
  return thrust_ == other.thrust_ && shaft_lags_s_ == other.shaft_lags_s_ &&
         delay_s_ == other.delay_s_ && output_travel_s_ == other.output_travel_s_ &&
         Hooked(Hook::kCommand) == other.Hooked(Hook::kCommand) && own.structure == its.structure &&
         own.parameterization == its.parameterization && own.dead_zone == its.dead_zone &&
         own.thrust_imbalance == its.thrust_imbalance &&
         own.thruster_time_constant_s == its.thruster_time_constant_s;
}

double AugmentedBoat::MeasuredHeadingRad(double psi_rad) const {
  double measured = psi_rad;
  for (const auto& [effect, values] : Hooked(Hook::kHeading)) {
    measured += effect->HeadingErrorRad(values, psi_rad);
  }
  return measured;
}

double AugmentedBoat::MeasuredHeadingSlope(double psi_rad) const {
  constexpr double kStepRad = 1e-4;
  return (MeasuredHeadingRad(psi_rad + kStepRad) - MeasuredHeadingRad(psi_rad - kStepRad)) /
         (2.0 * kStepRad);
}

double AugmentedBoat::TrueHeadingRad(double measured_rad) const {
  // Errors change slowly with the heading: each round leaves a fraction of the last one's error.
  constexpr int kRounds = 6;
  double psi = measured_rad;
  for (int round = 0; round < kRounds; ++round) psi += measured_rad - MeasuredHeadingRad(psi);
  return psi;
}

AugmentedBoat::Flow AugmentedBoat::FlowAt(const Nu& nu, const Eta& eta) const {
  if (current_.isZero(0.0) && current_gradient_.isZero(0.0)) return {nu, {}};
  const Eigen::Matrix2d to_body = Eigen::Rotation2Dd(-eta.psi_rad).toRotationMatrix();
  const Eigen::Vector2d from_middle = Eigen::Vector2d(eta.x_m, eta.y_m) - frame_.middle_m;
  const Eigen::Vector2d water = to_body * (current_ + current_gradient_ * from_middle);
  const Eigen::Vector2d over_ground = to_body.transpose() * Eigen::Vector2d(nu.u, nu.v);
  const Eigen::Vector2d changing = to_body * (current_gradient_ * over_ground);
  return {{nu.u - water[0], nu.v - water[1], nu.r},
          {nu.r * water[1] + changing[0], -nu.r * water[0] + changing[1], 0.0}};
}

void AugmentedBoat::ShareThrust(InstantState& instant) const {
  const double reverse_share = model_.model.reverse_loss.Share(instant.nu_r.u);
  for (NuDot& thrust : instant.thrust) {
    if (thrust.u < 0.0) thrust = Times(thrust, reverse_share);
  }
  for (const auto& [effect, values] : Hooked(Hook::kThrustShare)) {
    for (const Side side : {Side::kPort, Side::kStarboard}) {
      NuDot& thrust = instant.thrust[side == Side::kPort ? 0 : 1];
      thrust = Times(thrust, effect->ThrustShare(values, side, instant));
    }
  }
}

NuDot AugmentedBoat::Acceleration(const Nu& nu, const Eta& eta, const Drive& drive,
                                  double time_s) const {
  const Flow flow = FlowAt(nu, eta);
  // Every member, so that nothing is set to zero first: this is the innermost of loops.
  InstantState instant{.time_s = time_s - frame_.start_s,
                       .span_s = frame_.span_s,
                       .psi_rad = eta.psi_rad,
                       .load = drive.load,
                       .nu = nu,
                       .nu_r = flow.nu_r,
                       .thrust = drive.thrust,
                       .hull_scale = hull_scale_,
                       .hull = Times(hull_, BodyRowAt(flow.nu_r))};
  ShareThrust(instant);
  NuDot nu_dot = Plus(flow.nu_c_dot, instant.Acceleration());
  for (const auto& [effect, values] : Hooked(Hook::kAcceleration)) {
    nu_dot = Plus(nu_dot, effect->AddedAcceleration(values, instant));
  }
  return nu_dot;
}

Pose AugmentedBoat::Advance(const Pose& from, const Drive& drive, double time_s,
                            double step_s) const {
  const auto turned = [&](double by_rad) {
    Eta eta = from.eta;
    eta.psi_rad += by_rad;
    return eta;
  };
  const NuDot k1 = Acceleration(from.nu, from.eta, drive, time_s);
  if (model_.model.discretisation == Discretisation::kForwardEuler) {
    const Nu nu = Along(from.nu, k1, step_s);
    return {NextPose(from.eta, from.nu, nu, step_s), nu};
  }
  const double half = step_s / 2.0;
  const Eta halfway = turned(half * from.nu.r);
  const NuDot k2 = Acceleration(Along(from.nu, k1, half), halfway, drive, time_s + half);
  const NuDot k3 = Acceleration(Along(from.nu, k2, half), halfway, drive, time_s + half);
  if (step_s > kShortestStepS && IsStiff(k1, k2, k3)) {
    return Advance(Advance(from, drive, time_s, half), drive, time_s + half, half);
  }
  const NuDot k4 = Acceleration(Along(from.nu, k3, step_s),
                                turned(step_s * (from.nu.r + half * k1.r)), drive, time_s + step_s);
  const Nu nu = Along(from.nu, Plus(Plus(Plus(k1, k2, 2.0), k3, 2.0), k4), step_s / 6.0);
  return {NextPose(from.eta, from.nu, nu, step_s), nu};
}

std::vector<Pose> AugmentedBoat::Simulate(const Pose& from, std::span<const Drive> drives,
                                          double from_s, double step_s) const {
  std::vector<Pose> track = {from};
  track.reserve(drives.size() + 1);
  for (std::size_t k = 0; k < drives.size(); ++k) {
    track.push_back(
        Advance(track.back(), drives[k], from_s + static_cast<double>(k) * step_s, step_s));
  }
  return track;
}

}  // namespace telltale
