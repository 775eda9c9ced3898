#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

namespace blind::truth {

/// Random numbers that are the same with every compiler and standard library: SplitMix64 (Steele,
/// Lea, Flood 2014) and Box-Muller.
class RandomStream {
 public:
  explicit RandomStream(std::uint64_t seed) : state_(seed) {}

  /// RandomStream of their own for a purpose, so that drawing more for one changes nothing of
  /// another.
  RandomStream For(std::string_view purpose, std::uint64_t number = 0) const;

  std::uint64_t Bits();
  double Uniform(double from, double to);
  /// Of no preferred size between two that are positive.
  double LogUniform(double from, double to);
  double Normal(double sigma = 1.0);
  std::size_t Below(std::size_t count);
  double Sign() { return Below(2) == 0 ? -1.0 : 1.0; }
  bool Happens(double probability) { return Uniform(0.0, 1.0) < probability; }
  double Angle();

  template <typename T>
  void Shuffle(std::vector<T>& things) {
    for (std::size_t left = things.size(); left > 1; --left) {
      std::swap(things[left - 1], things[Below(left)]);
    }
  }

 private:
  std::uint64_t state_;
};

/// First-order Gauss-Markov process, stationary from the start.
class GaussMarkov {
 public:
  GaussMarkov(double sigma, double time_constant_s, RandomStream rng);
  double Step(double dt_s);
  double value() const { return value_; }

 private:
  double sigma_;
  double time_constant_s_;
  RandomStream rng_;
  double value_;
};

}  // namespace blind::truth
