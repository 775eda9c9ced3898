#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "telltale/core/uncertainty/interval.hpp"

namespace telltale {

/// How many of some repeats did what was promised of them.
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

/// How one coefficient's bounds did among the repeats that bounded it.
struct CoefficientCoverage {
  Tally tally;        ///< intervals that held the truth
  double bias = 0.0;  ///< mean of (estimate - truth) / standard error

  /// Of the coverage, at kCoverageLevel.
  Interval Bounds() const;
};

/// How often the bounds of a model hold when the model is the truth: measured on simulated repeats
/// of the very data set, docs/concepts/model.md (60). It says nothing of what lies outside the
/// model class.
struct CoverageCheck {
  std::size_t replicates_requested = 0;
  std::size_t replicates_identified =
      0;  ///< repeats that could be sailed and identified; the others failed
  std::uint64_t seed = 0;
  double level = 0.0;                             ///< that the bounds promise
  std::vector<CoefficientCoverage> coefficients;  ///< one for each of the identification
  std::optional<CoefficientCoverage> thruster_time_constant;
  Tally joint;                       ///< ellipsoids of all coefficients that held them all
  double mean_coverage = 0.0;        ///< of all intervals there are
  double mean_coverage_error = 0.0;  ///< its standard error: coefficients of a repeat err together
  bool truth_is_reported_model =
      false;  ///< false: about a tamer one, since the published runs away

  std::size_t Failures() const { return replicates_requested - replicates_identified; }
};

}  // namespace telltale
