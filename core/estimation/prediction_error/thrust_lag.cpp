#include "telltale/core/estimation/prediction_error/thrust_lag.hpp"

#include <algorithm>
#include <cmath>

namespace telltale {
namespace {

using Thrusts = FossenDynamics::Thrusts;

Thrusts Regress(double delta, const DeadZone& dead_zone) {
  const double e = dead_zone.Apply(delta);
  return e > 0.0 ? Thrusts(e, e * e, 0.0, 0.0) : Thrusts(0.0, 0.0, e, e * e);
}

// The first two by the dead band ahead, the last two by that in reverse.
Thrusts RegressByDeadBands(double delta, const DeadZone& dead_zone) {
  const double e = dead_zone.Apply(delta);
  if (e > 0.0) return {-1.0, -2.0 * e, 0.0, 0.0};
  if (e < 0.0) return {0.0, 0.0, 1.0, 2.0 * e};
  return Thrusts::Zero();
}

}  // namespace

ThrustLag::ThrustLag(const HeldCommands& commands, const Lag& lag, double start_s)
    : times_s_(commands.Times()),
      commands_(commands.Commands()),
      lag_(lag),
      now_s_(start_s - lag.delay_s) {
  // The thrust has settled before the first command.
  Enter(0);
  state_ = target_;
  for (Thrusts& by : state_by_time_constant_) by.setZero();
  const double begin_s = now_s_;
  const double first_s = begin_s - 10.0 * lag.time_constant_s;
  const auto found = std::upper_bound(times_s_.begin(), times_s_.end(), first_s);
  if (found != times_s_.begin()) Enter(static_cast<std::size_t>(found - times_s_.begin()) - 1);
  state_ = target_;
  now_s_ = std::min(begin_s, std::max(first_s, times_s_.front()));
  if (now_s_ < begin_s) Until(begin_s + lag_.delay_s);
}

ThrustLag::Target ThrustLag::TargetOf(const PropellerCommand& command) const {
  Target target;
  target.value[0] = Regress(command.port, lag_.dead_zone);
  target.value[1] = Regress(command.starboard, lag_.dead_zone);
  target.by_dead_bands[0] = RegressByDeadBands(command.port, lag_.dead_zone);
  target.by_dead_bands[1] = RegressByDeadBands(command.starboard, lag_.dead_zone);
  return target;
}

void ThrustLag::Enter(std::size_t piece) {
  piece_ = piece;
  target_ = TargetOf(commands_[piece]);
}

ThrustStep ThrustLag::Until(double end_s) {
  const double to_s = end_s - lag_.delay_s;
  const double duration_s = to_s - now_s_;
  const double tau = lag_.time_constant_s;
  const Target before = state_;
  ThrustStep step;
  for (int side = 0; side < 2; ++side) {
    step.mean[side].setZero();
    step.early[side].setZero();
    step.by_dead_bands[side].setZero();
    step.by_time_constant[side].setZero();
  }
  while (now_s_ < to_s) {
    const bool last = piece_ + 1 >= times_s_.size();
    const double piece_end_s = last ? to_s : std::min(times_s_[piece_ + 1], to_s);
    const double span_s = std::max(piece_end_s - now_s_, 0.0);
    const double remaining = std::exp(-span_s / tau);
    const double memory_s = tau * (1.0 - remaining);
    const double left_s = to_s - piece_end_s;
    const double target_moment = span_s * (left_s + 0.5 * span_s);
    const double off_moment = left_s * memory_s + tau * (span_s - memory_s);
    for (int side = 0; side < 2; ++side) {
      const Thrusts off = state_.value[side] - target_.value[side];
      const Thrusts off_by_dead_bands = state_.by_dead_bands[side] - target_.by_dead_bands[side];
      step.mean[side] += target_.value[side] * span_s + off * memory_s;
      step.early[side] += target_.value[side] * target_moment + off * off_moment;
      step.by_dead_bands[side] +=
          target_.by_dead_bands[side] * span_s + off_by_dead_bands * memory_s;
      step.by_time_constant[side] += state_by_time_constant_[side] * memory_s +
                                     off * (1.0 - remaining - remaining * span_s / tau);
      state_by_time_constant_[side] =
          remaining * (state_by_time_constant_[side] + off * (span_s / (tau * tau)));
      state_.value[side] = target_.value[side] + remaining * off;
      state_.by_dead_bands[side] = target_.by_dead_bands[side] + remaining * off_by_dead_bands;
    }
    now_s_ = piece_end_s;
    if (!last && now_s_ >= times_s_[piece_ + 1]) Enter(piece_ + 1);
  }
  for (int side = 0; side < 2; ++side) {
    step.early[side] -= 0.5 * duration_s * step.mean[side];
    step.mean[side] /= duration_s;
    step.by_dead_bands[side] /= duration_s;
    step.by_time_constant[side] /= duration_s;
    step.by_delay[side] = -(state_.value[side] - before.value[side]) / duration_s;
  }
  return step;
}

}  // namespace telltale
