#pragma once

#include "telltale/core/vessel/motion.hpp"

namespace telltale {

/// Where in a step a slope is taken.
enum class StepStage { kStart, kMiddle, kEnd };

/// A step of length `h` by the classical Runge-Kutta method of order four: four slopes, one at the
/// start, two in the middle and one at the end.
/// slope_at(state, stage): the state's derivative. along(state, slope, duration): the state that
/// follows a slope for a duration. combine(k1, k2, k3, k4): the state after the step, from
/// (k1 + 2 k2 + 2 k3 + k4) / 6.
/// Source: Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, table 1.2.
template <class State, class SlopeAt, class Along, class Combine>
State RungeKuttaStep(const State& from, double h, const SlopeAt& slope_at, const Along& along,
                     const Combine& combine) {
  const auto k1 = slope_at(from, StepStage::kStart);
  const auto k2 = slope_at(along(from, k1, h / 2), StepStage::kMiddle);
  const auto k3 = slope_at(along(from, k2, h / 2), StepStage::kMiddle);
  const auto k4 = slope_at(along(from, k3, h), StepStage::kEnd);
  return combine(k1, k2, k3, k4);
}

/// The velocity that follows an acceleration for `duration_s`.
inline Nu Along(const Nu& nu, const NuDot& slope, double duration_s) {
  return {nu.u + duration_s * slope.u, nu.v + duration_s * slope.v, nu.r + duration_s * slope.r};
}

/// The same step for a body velocity; slope_at(nu, stage) is its acceleration.
template <class SlopeAt>
Nu RungeKuttaStep(const Nu& from, double step_s, const SlopeAt& slope_at) {
  return RungeKuttaStep(from, step_s, slope_at, Along,
                        [&](const NuDot& k1, const NuDot& k2, const NuDot& k3, const NuDot& k4) {
                          const NuDot mean{(k1.u + 2 * k2.u + 2 * k3.u + k4.u) / 6,
                                           (k1.v + 2 * k2.v + 2 * k3.v + k4.v) / 6,
                                           (k1.r + 2 * k2.r + 2 * k3.r + k4.r) / 6};
                          return Along(from, mean, step_s);
                        });
}

}  // namespace telltale
