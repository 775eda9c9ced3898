#pragma once

namespace telltale {

/// Whether a model no longer fits: a cumulative sum of its prediction error, in units of the error
/// when it was identified, beyond what other weather may add. It fires where the error stays large,
/// the sooner the larger it is: after two minutes at three times the error, after five or six at
/// twice, and never below 1.75 times; how often of a healthy boat stands in
/// docs/guides/operations.md. Source: E. S. Page, "Continuous inspection schemes", Biometrika 41
/// (1954).
class DriftDetector {
 public:
  /// Takes in the error of one more evaluation, with five seconds or more of new data.
  void Add(double relative_error);

  /// Once fired, until the error has been small for long enough to make up for what it was.
  bool Fires() const { return fires_; }

 private:
  double excess_ = 0.0;
  bool fires_ = false;
};

}  // namespace telltale
