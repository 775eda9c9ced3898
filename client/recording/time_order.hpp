#pragma once

#include <cstddef>
#include <functional>
#include <variant>
#include <vector>

#include "telltale/core/data/samples.hpp"

namespace telltale {

/// Three channels as recorded, each in the order it was written: nothing checked yet.
struct RawChannels {
  std::vector<GnssFix> gnss;
  std::vector<HeadingSample> heading;
  std::vector<ThrusterSample> thrusters;

  std::size_t Size() const { return gnss.size() + heading.size() + thrusters.size(); }
};

/// One raw sample of any channel.
using RawSample = std::variant<GnssFix, HeadingSample, ThrusterSample>;

double TimeOf(const RawSample& sample);

/// Visits the samples in the order in which a receiver would have seen them. Samples of one channel
/// keep their order, wrong times included, so that a Window checks them as it would check them
/// live. A wrong time does not hold its channel back: a sample is placed by the median of its own
/// and its neighbours' times. A clock that was set back (by more than a minute, for good) begins a
/// new epoch, which comes after the old one in all channels.
void ForEachInOrderOfTime(const RawChannels& channels,
                          const std::function<void(const RawSample&)>& visit);

/// The samples in that order.
std::vector<RawSample> InOrderOfTime(const RawChannels& channels);

}  // namespace telltale
