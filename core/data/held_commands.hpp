#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/data/samples.hpp"
#include "telltale/core/vessel/propellers.hpp"
#include "telltale/core/vessel/vehicle.hpp"

namespace telltale {

/// The normalised commands as the propellers received them, each held from its time until the next.
/// Beyond the ends the first and the last are held. Requires: at least one sample.
class HeldCommands {
 public:
  HeldCommands(std::span<const ThrusterSample> samples, const Vehicle& vehicle);

  PropellerCommand At(double t) const;

  /// Mean over [from, to], weighted by time. Requires: from < to.
  PropellerCommand Mean(double from, double to) const;

  /// Mean weighted by a triangle about `t` that vanishes at t - half_width and t + half_width. It
  /// drives the difference between the mean velocities of the intervals before and after `t`.
  PropellerCommand TriangularMean(double t, double half_width) const;

  /// The region in force for most of [from, to]; the earliest of equals. Requires: from < to.
  PropellerRegion MajorityRegion(double from, double to) const;

  /// Calls visit(command, start, end) for each held piece of [from, to]. Requires: from < to.
  template <class Visit>
  void ForEachPiece(double from, double to, Visit visit) const {
    Require(from < to, "an interval that is not empty");
    for (std::size_t i = IndexAt(from); from < to; ++i) {
      const double end = i + 1 < times_s_.size() ? std::clamp(times_s_[i + 1], from, to) : to;
      visit(commands_[i], from, end);
      from = end;
    }
  }

  /// Replaces each command by change(command).
  template <class Change>
  void ForEachCommand(Change change) {
    for (PropellerCommand& command : commands_) command = change(command);
  }

  /// Replaces each time by change(the time before as it was, time) and keeps their order. The first
  /// one stays.
  template <class Change>
  void ForEachTime(Change change) {
    double before_s = times_s_.front();
    for (std::size_t i = 1; i < times_s_.size(); ++i) {
      const double time_s = times_s_[i];
      times_s_[i] = std::max(times_s_[i - 1], change(before_s, time_s));
      before_s = time_s;
    }
  }

  const std::vector<double>& Times() const { return times_s_; }
  const std::vector<PropellerCommand>& Commands() const { return commands_; }

 private:
  std::size_t IndexAt(double t) const;

  std::vector<double> times_s_;
  std::vector<PropellerCommand> commands_;
};

}  // namespace telltale
