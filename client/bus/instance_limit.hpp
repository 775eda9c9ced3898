#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <unordered_set>
#include <utility>

#include "telltale/client/bus/endpoint.hpp"

namespace telltale {

/// Keeps the samples of further keys from a reader once it has had so many keys: each takes memory
/// until its writers leave, and anybody can invent keys. A key that has left counts on. For the
/// topics that are reliable: where the quality of service bounds their instances, Cyclone DDS holds
/// up the writers once the bound is reached. Thread safe.
/// Assumes: samples have data. That an unknown key is disposed of passes.
class InstanceLimit {
 public:
  explicit InstanceLimit(std::size_t most) : most_(most) {}
  InstanceLimit(const InstanceLimit&) = delete;
  InstanceLimit& operator=(const InstanceLimit&) = delete;

  /// Applies to the readers of this topic that are made afterwards. The limit outlives them.
  void ApplyTo(const Entity& topic);

  /// How many samples were refused since this was last asked.
  std::uint64_t TakeRefused();

 private:
  static bool Admits(const dds_sample_info_t* sample, void* limit);
  bool Admits(InstanceHandle instance);

  const std::size_t most_;
  std::mutex mutex_;  // of what follows
  std::unordered_set<InstanceHandle> admitted_;
  std::uint64_t refused_ = 0;
};

}  // namespace telltale
