#pragma once

#include <cstddef>
#include <cstdint>

#include "telltale/core/data/samples.hpp"

namespace telltale {

/// The samples that a window has kept and no store has yet, in their order. They take no more
/// memory than the bound: where more come, the oldest eighth of each channel goes. Not thread safe.
class UnsavedSamples {
 public:
  explicit UnsavedSamples(std::size_t memory_bytes) : memory_bytes_(memory_bytes) {}

  void LimitMemory(std::size_t memory_bytes);
  void Add(const GnssFix& fix);
  void Add(const HeadingSample& heading);
  void Add(const ThrusterSample& thrusters);

  /// All of them; none is left.
  Recording Take();

  std::size_t size() const;
  std::uint64_t dropped() const { return dropped_; }

 private:
  void DropBeyondLimit();

  std::size_t memory_bytes_;
  Recording samples_;
  std::uint64_t dropped_ = 0;
};

}  // namespace telltale
