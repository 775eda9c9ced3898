#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/diagnosis/diagnosis.hpp"
#include "telltale/core/diagnosis/residuals/free_runs.hpp"

namespace telltale {

/// All three channels of a free run's errors together.
inline constexpr int kAllChannels = 3;

/// The error of a boat's free runs on nominal recordings.
struct NoiseFloor {
  Eigen::VectorXd scale;                        ///< root mean square of each row's error
  std::vector<std::array<double, 4>> log_gaps;  ///< ln G^2 of each recording, by channel and of all
  std::array<double, 4> spread{};  ///< one sigma of a recording's ln G^2, from day to day

  /// G^2 of nominal recordings, their geometric mean.
  double Squared(int channel) const;
  /// What 95 % of nominal recordings stay below, by Student's t over the recordings there are.
  double SquaredLimit(int channel) const;
};

/// Of the errors of each recording, rows x windows, and the blocks of their windows. Requires: at
/// least one recording with windows.
NoiseFloor NoiseFloorOf(const std::vector<Eigen::MatrixXd>& errors,
                        const std::vector<std::vector<std::size_t>>& blocks);

/// The same, simulated. Requires: at least one recording with windows.
NoiseFloor NoiseFloorOf(const std::vector<FreeRuns>& recordings, const AugmentedModel& boat);

/// Mean squared errors in nominal scales by window, of one channel or of all: G^2 is their mean,
/// docs/concepts/diagnosis.md (80). The error of a window is cut, so that a diverged model counts
/// as wrong without a size.
Eigen::VectorXd SquaredGaps(const Eigen::MatrixXd& errors, const Eigen::VectorXd& scale,
                            int channel);

/// What 99 % of nominal days stay below in G^2, by Student's t over days that took no part in the
/// baseline that each was scored by. Requires: at least two, each > 0.
double SquaredLimitOfDays(const std::vector<double>& squared_gaps);

/// The block of each window, half a minute long. Errors in a block may be correlated, so blocks are
/// the units of resampling.
std::vector<std::size_t> BlocksOf(const FreeRuns& runs);

/// Sums of both over the windows of each block.
std::vector<std::array<double, 2>> SumsByBlock(const Eigen::VectorXd& one,
                                               const Eigen::VectorXd& other,
                                               const std::vector<std::size_t>& blocks);

/// What G^2 stays below with 95 %, by resampling blocks.
double UpperBound(const Eigen::VectorXd& squared_gaps, const std::vector<std::size_t>& blocks,
                  std::uint64_t seed);

/// The excess error over the floor that `after` explains of `before`, with an interval by
/// resampling blocks of windows in pairs. None where before is not above the floor's limit.
std::optional<ExcessExplained> ExcessExplainedBy(const Eigen::VectorXd& before,
                                                 const Eigen::VectorXd& after,
                                                 const std::vector<std::size_t>& blocks,
                                                 const NoiseFloor& floor, int channel,
                                                 std::uint64_t seed);

}  // namespace telltale
