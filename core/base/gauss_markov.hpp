#pragma once

#include <cmath>
#include <cstdint>

#include <boost/random/normal_distribution.hpp>

#include "telltale/core/base/random.hpp"

namespace telltale {

/// Seeded normal white noise of unit variance, independent of every other stream of the same seed.
class WhiteSource {
 public:
  WhiteSource(std::uint64_t seed, std::uint64_t stream)
      : engine_(RandomEngine::Stream(seed, stream)) {}

  double operator()() { return normal_(engine_); }

 private:
  RandomEngine engine_;
  boost::random::normal_distribution<double> normal_;
};

/// A stationary first-order Gauss-Markov process of standard deviation sigma, exact at equal steps.
class GaussMarkov {
 public:
  /// Requires: time_constant_s > 0, step_s > 0.
  GaussMarkov(double sigma, double time_constant_s, double step_s, WhiteSource source)
      : source_(source),
        decay_(std::exp(-step_s / time_constant_s)),
        innovation_(sigma * std::sqrt(1.0 - decay_ * decay_)),
        value_(sigma * source_()) {}

  /// Returns the value now and advances the process by one step.
  double Next() {
    const double now = value_;
    value_ = decay_ * value_ + innovation_ * source_();
    return now;
  }

 private:
  WhiteSource source_;
  double decay_;
  double innovation_;
  double value_;
};

}  // namespace telltale
