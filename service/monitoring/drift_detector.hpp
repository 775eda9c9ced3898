#pragma once

namespace telltale {

/// Whether a model errs far more than any weather makes it, by a one-sided cumulative sum of the
/// relative prediction error beyond 4. The relative error is in units of the error when the model
/// was identified. A constant relative error of 6 raises the alarm after 10 evaluations, one of 4.5
/// after 40, and one of 4 or less never: DriftTest finds smaller changes by their pattern.
/// Source: E. S. Page, "Continuous inspection schemes", Biometrika 41 (1954).
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
