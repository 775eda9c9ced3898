#pragma once

#include <cstdint>
#include <limits>

namespace telltale {

/// Model: SplitMix64, a counter hashed to 64 bits. It is cheap to seed, so every replicate and
/// every sensor owns an engine, and results do not depend on how work is spread over threads.
/// Source: Steele, Lea, Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014.
class RandomEngine {
 public:
  using result_type = std::uint64_t;

  explicit RandomEngine(std::uint64_t seed) : state_(seed) {}

  /// The engine of item `index` in a family: independent of how many items come before it.
  static RandomEngine Stream(std::uint64_t seed, std::uint64_t index) {
    return RandomEngine(RandomEngine(seed ^ Mix(index + 1))());
  }

  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return std::numeric_limits<result_type>::max(); }

  result_type operator()() {
    state_ += 0x9e3779b97f4a7c15ULL;
    return Mix(state_);
  }

 private:
  static constexpr std::uint64_t Mix(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }

  std::uint64_t state_;
};

/// A uniform draw from 0 .. count - 1, its probabilities equal to within count / 2^32: the upper
/// half of a 32-bit number times count, which needs no division. Requires: count in [1, 2^32].
/// Source: Lemire, "Fast random integer generation in an interval", ACM TOMACS 29 (2019), without
/// its rejection step.
inline std::uint64_t DrawBelow(RandomEngine& engine, std::uint64_t count) {
  return ((engine() >> 32) * count) >> 32;
}

}  // namespace telltale
