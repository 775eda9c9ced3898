#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/weak_form/weak_iv.hpp"
#include "telltale/core/uncertainty/joint_bounds.hpp"
#include "telltale/core/vessel/disturbance.hpp"

namespace telltale {

struct BootstrapCorrectionOptions {
  std::size_t parametric_replicates = 40;  ///< [8, 1000]
  std::uint64_t seed = 1;
  std::size_t threads = 1;   ///< never changes the result
  double noise_scale = 1.0;  ///< sensor noise of the replicates, in units of what the data show
  double time_scale = 1.0;   ///< time constant of their disturbance, likewise
};

/// Shapes: theta P, covariance P x P, interval_factors P over the stacked unknowns of the WeakFit.
struct BootstrapCorrection {
  Eigen::VectorXd theta;             ///< corrected for bias
  Eigen::MatrixXd covariance;        ///< of the replicates' errors, enlarged for their small number
  Eigen::VectorXd interval_factors;  ///< by unknown, of its interval's length to Student's
  JointBounds joint;                 ///< calibrated so that ellipsoids hold
  double degrees_of_freedom = 0.0;   ///< of Student's t for intervals
  Disturbance disturbance;
  std::size_t solved = 0;    ///< replicates that could be estimated
  std::size_t failures = 0;  ///< replicates that could not
};

/// Bias correction and interval calibration by parametric bootstrap, docs/concepts/model.md (33),
/// (34). The residuals give the disturbance. Each replicate draws a plausible model, simulates the
/// dataset with it, and prepares and estimates the synthetic data. The replicates' mean error is
/// subtracted from the estimate. Their scatter about that mean sizes each direction of the
/// clusters' covariance. The coverage of intervals made in this way gives inflation factors, one
/// for each equation and one for each single interval.
/// Where more than half of the replicates fail, the search continues with more shrinkage.
/// `progress` is called by one thread at a time. Requires: 8 replicates or more. Nothing when fewer
/// than half of the replicates can be estimated at every shrinkage level, or numbers overflow.
std::optional<BootstrapCorrection> CorrectByParametricBootstrap(
    const PreparedDataset& dataset, const RegressionOptions& regression, const WeakFit& fit,
    const std::array<std::vector<std::size_t>, 3>& columns, const WeakIvOptions& options,
    const BootstrapCorrectionOptions& bootstrap,
    const std::function<void(double fraction)>& progress = {});

/// The disturbance that the residuals of a weak-form fit show in excess of the sensors' part, as
/// CorrectByParametricBootstrap() computes it. Nothing when the fit diverges at every shrinkage
/// level.
std::optional<Disturbance> DisturbanceFromResiduals(const PreparedDataset& dataset,
                                                    const RegressionOptions& regression,
                                                    const WeakFit& fit,
                                                    const WeakIvOptions& options,
                                                    std::uint64_t seed);

}  // namespace telltale
