#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "telltale/core/uncertainty/interval.hpp"

namespace telltale {

/// Successes among trials.
struct Tally {
  std::size_t held = 0;
  std::size_t of = 0;

  void Add(bool one_held);

  /// held / of; 0 of nothing.
  double Share() const;

  bool operator==(const Tally&) const = default;
};

/// Clopper-Pearson bounds of the probability behind a tally: the exact binomial ones, which hold at
/// least as often as `level` says. [0, 1] of nothing. Requires: held <= of, level in (0, 1).
Interval BinomialInterval(const Tally& tally, double level);

/// Of the intervals that say how well a coverage is known.
inline constexpr double kCoverageLevel = 0.95;

/// The coverage of one coefficient among the replicates that bound it.
struct CoefficientCoverage {
  Tally tally;        ///< intervals that held the truth
  double bias = 0.0;  ///< mean of (estimate - truth) / standard error

  /// Of the coverage, at kCoverageLevel.
  Interval Bounds() const;
};

/// Coverage check by simulation: how often the bounds of a model hold when the model is true, on
/// parametric bootstrap replicates of its dataset, docs/concepts/model.md (60). Errors outside the
/// model class are not part of it.
struct CoverageCheck {
  std::size_t replicates_requested = 0;
  std::size_t replicates_identified =
      0;  ///< replicates simulated and identified; the others failed
  std::uint64_t seed = 0;
  double level = 0.0;                             ///< that the bounds promise
  std::vector<CoefficientCoverage> coefficients;  ///< one for each of the identification
  std::optional<CoefficientCoverage> thruster_time_constant;
  Tally joint;                       ///< ellipsoids of all coefficients that held them all
  double mean_coverage = 0.0;        ///< of all intervals there are
  double mean_coverage_error = 0.0;  ///< its standard error, across replicates
  bool truth_is_reported_model =
      false;  ///< false: about a regularised one, since the reported model diverges

  std::size_t Failures() const { return replicates_requested - replicates_identified; }
};

}  // namespace telltale
