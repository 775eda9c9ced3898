#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "telltale/core/data/samples.hpp"

namespace telltale {

/// Counts consecutive samples whose stamps lie off a window's clock and agree with each other: they
/// may follow a new clock of the boat.
class ClockCheck {
 public:
  /// The number of consecutive samples, this one included, that agree within
  /// `consistent_within_s`. A sample that disagrees starts the count again; a stamp that does not
  /// advance on its channel adds nothing.
  std::size_t Count(Channel channel, double time_s, double consistent_within_s) {
    if (count_ == 0 || std::abs(time_s - latest_s_) > consistent_within_s) Reset();
    double& of_channel = latest_of_[static_cast<std::size_t>(channel)];
    if (time_s > of_channel) ++count_;
    of_channel = std::max(of_channel, time_s);
    latest_s_ = time_s;
    return count_;
  }

  void Reset() { *this = ClockCheck(); }

 private:
  static constexpr double kNever = -std::numeric_limits<double>::infinity();

  std::size_t count_ = 0;
  double latest_s_ = kNever;
  std::array<double, kChannels.size()> latest_of_ = {kNever, kNever, kNever};
};

}  // namespace telltale
