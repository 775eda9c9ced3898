#pragma once

namespace telltale {

/// Whether a model no longer fits, by a one-sided cumulative sum of the relative prediction error
/// beyond 1.75, which changes of weather may reach. The relative error is in units of the error
/// when the model was identified. A constant relative error of 3 raises the alarm after 16
/// evaluations, one of 2 after 80, and one of 1.75 or less never. docs/guides/operations.md states
/// the rate of false alarms. Source: E. S. Page, "Continuous inspection schemes", Biometrika 41
/// (1954).
class DriftDetector {
 public:
  /// Adds the relative error of one evaluation, with 5 s or more of new data. NaN is ignored.
  void Add(double relative_error);

  /// True from the time that the sum reaches its threshold until it is back at zero.
  bool Fires() const { return fires_; }

  /// Whether the sum is above zero. The time at which it last left zero estimates the onset.
  bool Rises() const { return excess_ > 0.0; }

 private:
  double excess_ = 0.0;
  bool fires_ = false;
};

}  // namespace telltale
