#pragma once

#include <variant>
#include <vector>

#include "telltale/core/data/samples.hpp"

namespace telltale {

/// One raw sample of any channel, as recorded: nothing checked yet.
using RawSample = std::variant<GnssFix, HeadingSample, ThrusterSample>;

double TimeOf(const RawSample& sample);

/// The samples of one channel, in their order.
template <class Sample>
std::vector<Sample> SamplesOf(const std::vector<RawSample>& samples) {
  std::vector<Sample> channel;
  for (const RawSample& sample : samples) {
    if (const auto* one = std::get_if<Sample>(&sample)) channel.push_back(*one);
  }
  return channel;
}

/// Three channels, each in the order it was written, woven into the order in which a receiver would
/// have seen them. Samples of one channel keep their order, wrong times included, so that a Window
/// checks them as it would check them live. A wrong time does not hold its channel back: a
/// sample is placed by the median of its own and its neighbours' times. A clock that was set back
/// (by more than a minute, for good) begins a new epoch, which comes after the old one in all
/// channels.
std::vector<RawSample> InOrderOfTime(const std::vector<GnssFix>& gnss,
                                     const std::vector<HeadingSample>& heading,
                                     const std::vector<ThrusterSample>& thrusters);

}  // namespace telltale
