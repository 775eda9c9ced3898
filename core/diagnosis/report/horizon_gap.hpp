#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/diagnosis/diagnosis.hpp"
#include "telltale/core/diagnosis/hypotheses/cross_validation.hpp"
#include "telltale/core/diagnosis/residuals/gap.hpp"
#include "telltale/core/diagnosis/residuals/horizon_runs.hpp"

namespace telltale {

/// The free runs of a recording at one horizon, with the errors of the nominal boat.
struct HorizonErrors {
  const FreeRuns& runs;    ///< has to outlive it
  NoiseFloor floor;        ///< of the references
  Eigen::MatrixXd errors;  ///< of the nominal boat, rows x windows

  /// SquaredGaps of those errors, by window.
  Eigen::VectorXd SquaredGapsOf(int channel) const {
    return SquaredGaps(errors, floor.scale, channel);
  }
};

/// One for each horizon, in order.
std::vector<HorizonErrors> HorizonErrorsOf(const RunsByHorizon& runs, const AugmentedModel& boat);

/// The gap at one horizon, by channel and of all. `after`: cross-validated errors of the likely
/// hypothesis; without any, the gap after is the gap before.
Gap GapAt(const HorizonErrors& horizon, const std::optional<CrossValidatedErrors>& after,
          std::uint64_t seed);

/// The share of the excess error that a hypothesis explains; none where there is no gap.
std::optional<ExcessExplained> ExcessExplainedAt(const HorizonErrors& horizon,
                                                 const CrossValidatedErrors& after, int channel,
                                                 std::uint64_t seed);

}  // namespace telltale
