#pragma once

#include <set>

#include "telltale/core/data/samples.hpp"

namespace telltale {

/// The channels that are taken of a source; none: all. Where a boat speaks two ways, each brings
/// the channels that it is better at.
using ChannelChoice = std::set<Channel>;

inline bool Takes(const ChannelChoice& choice, Channel channel) {
  return choice.empty() || choice.contains(channel);
}

}  // namespace telltale
