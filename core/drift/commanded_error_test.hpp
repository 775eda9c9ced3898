#pragma once

#include <array>
#include <deque>
#include <vector>

#include "telltale/core/drift/drift_constants.hpp"
#include "telltale/core/drift/run_errors.hpp"

namespace telltale {

/// Whether a model errs far more than normally because of what its boat is told to do, whatever it
/// is that has changed. Weather of any strength makes errors too, yet none that follow the
/// commands. Model: the mean errors of runs by least squares on what wind and current do and on
/// what the commands do, RunError. Of the mean square of the errors the share counts that the
/// commands alone explain, less what chance explains, where the F-test of the commands tells them
/// from chance. The explained error is the root mean square of these over the three velocities, in
/// normal errors; docs/concepts/diagnosis.md (127). It decides whichever one block is left out.
/// Assumes: errors of neighbouring runs are independent, and no gust moves the commands. What it
/// says stays where the commands hardly change, or most runs are missing. Source: Seber, Lee,
/// "Linear regression analysis" (2003), chapter 4.
class CommandedErrorTest {
 public:
  /// `normal`: root mean squares of the errors while nothing had changed. Requires: each > 0.
  explicit CommandedErrorTest(const std::array<double, 3>& normal) : normal_(normal) {}

  /// The runs of one more block.
  void Add(std::vector<RunError> block);

  /// True from the time that the explained error is beyond kDrift.tolerated_error whichever block
  /// is left out until runs with varied commands show it within.
  bool Fires() const { return fires_; }

  /// Whether it is beyond. The time at which this began estimates the onset.
  bool Rises() const { return explained_ > kDrift.tolerated_error; }

  /// The explained error, in normal errors.
  double Explained() const { return explained_; }

 private:
  bool CanTell() const;
  double ExplainedWithout(const std::vector<RunError>* left_out) const;
  bool IsBeyondDoubt() const;

  std::array<double, 3> normal_;
  std::deque<std::vector<RunError>> blocks_;  ///< oldest first
  double explained_ = 0.0;
  bool fires_ = false;
};

}  // namespace telltale
