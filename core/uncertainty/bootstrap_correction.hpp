#pragma once

#include <array>
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
  double noise_scale = 1.0;  ///< sensor noise of the twins against what the data show
  double time_scale = 1.0;   ///< their disturbance's time constant against what the data show
};

/// Shapes: theta and covariance over the stacked unknowns of the WeakFit.
struct BootstrapCorrection {
  Eigen::VectorXd theta;             ///< corrected for bias
  Eigen::MatrixXd covariance;        ///< as the twins scattered, with what few of them leave open
  Eigen::VectorXd interval_factors;  ///< by unknown, of its interval beside Student's
  JointBounds joint;                 ///< calibrated so that ellipsoids hold
  double degrees_of_freedom = 0.0;   ///< of Student's t for intervals
  Disturbance disturbance;
  std::size_t solved = 0;    ///< twins that could be estimated
  std::size_t failures = 0;  ///< twins that could not
};

/// Bias correction and calibration by simulating the whole pipeline, docs/concepts/model.md (33),
/// (34): the disturbance is judged from the residuals; twins of the data set, each another boat as
/// plausible as the next, are sailed, measured, prepared and estimated again. What they are off by
/// on average is taken from the estimate, how they scatter about that sizes each direction of the
/// clusters' covariance, and how often intervals made like that hold says by what factor they have
/// to be stretched: all of an equation together, and single ones once more each. Where most twins
/// run away it starts again with plainer boats. progress is called by one thread at a time. Nothing
/// when even of the plainest fewer than half can be estimated, or numbers overflow.
std::optional<BootstrapCorrection> CorrectByParametricBootstrap(
    const PreparedDataset& dataset, const RegressionOptions& regression, const WeakFit& fit,
    const std::array<std::vector<std::size_t>, 3>& columns, const WeakIvOptions& options,
    const BootstrapCorrectionOptions& parametric_replicates,
    const std::function<void(double fraction)>& progress = {});

/// The disturbance that the residuals of a fit show beyond what sensors leave in still water, as
/// CorrectByParametricBootstrap() judges it. Nothing when the fit cannot be sailed.
std::optional<Disturbance> DisturbanceFromResiduals(
    const PreparedDataset& dataset, const RegressionOptions& regression, const WeakFit& fit,
    const std::array<std::vector<std::size_t>, 3>& columns, const WeakIvOptions& options,
    std::uint64_t seed);

}  // namespace telltale
